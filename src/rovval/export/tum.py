"""TUM trajectories (cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats): ``timestamp tx ty tz qx qy qz qw`` in s and m, for evo."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rovval.core.errors import BadInput
from rovval.export.content import Content
from rovval.storage.atomic import drafts

SUFFIX = ".tum"


def write(content: Content, path: Path) -> tuple[Path, ...]:
    """The measured trajectory, and those of a simulation beside it as NAME_simulated.tum and NAME_simulated_windows.tum; samples without
    a whole pose are left out. Raises `BadInput` where no sample has one, and as `drafts` does."""
    motions = {name: motion for name, motion in content.motions().items() if motion.posed.any()}
    if "" not in motions:
        gone = ", ".join(n for n in ("x", "y", "z", "phi", "theta", "psi") if not content.run.measured(n))
        raise BadInput(f"run {content.run.id}: no sample has a whole pose ({gone or 'never all at once'} missing), and a trajectory is poses", "use --to csv")
    places = {name: path.with_name(f"{path.stem}_{name.replace('/', '_')}{path.suffix}") if name else path for name in motions}
    stamps = content.stamps_ns
    with drafts(*places.values()) as written:
        for draft, motion in zip(written, motions.values(), strict=True):
            lines = []
            for i in np.flatnonzero(motion.posed):
                w, *xyz = motion.orientation[i].tolist()
                numbers = " ".join(repr(v) for v in (*motion.position[i].tolist(), *xyz, w))
                lines.append(f"{stamps[i] // 10**9}.{stamps[i] % 10**9:09d} {numbers}\n")
            draft.write_text("".join(lines), encoding="ascii")
    return tuple(places.values())

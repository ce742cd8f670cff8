"""`rovval import-vehicle`: a vehicle of uuv_simulator or Plankton, or of the thesis's Simulink project, as a vehicle file of ours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rovval.cli import complete, options, output
from rovval.core.errors import UsageProblem

if TYPE_CHECKING:
    from rovval.vehicle.model import Vehicle


def command(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE.yaml...|FOLDER",
            help="YAML of the model, of the allocation matrix (TAM) and of the thruster manager, one file or several; or the folder of "
            "text matrices (M_RB.txt, T.txt, K_T.txt ...) of the thesis's Simulink project.",
            autocompletion=complete.yaml_files,
        ),
    ],
    out: Annotated[Path, typer.Option("--out", metavar="VEHICLE.toml", help="Where the vehicle is written.")],
    name: Annotated[str | None, typer.Option("--name", help="The vehicle's name. Default: that of VEHICLE.toml.")] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Write over VEHICLE.toml if it is there.")] = False,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Read a vehicle from the YAML of uuv_simulator or Plankton, or from the thesis's folder of text matrices, and write it as TOML,
    in rovval's axes and signs, audited.

    Forward-left-up becomes forward-starboard-down, negative damping positive, the thrusters' gain N per rpm^2. Nothing is
    written unless every number is there and can be a vehicle's.

    \b
    Example:
      rovval import-vehicle rexrov.yaml TAM.yaml thrusters.yaml --out rexrov.toml
      rovval import-vehicle preprocessing/minerva --out minerva.toml
      rovval show vehicle rexrov.toml
    """
    from rovval.storage.atomic import write_text
    from rovval.vehicle import parse, text_matrices, uuv_yaml

    if out.suffix != ".toml":
        raise UsageProblem(f"--out {out}: a vehicle file ends in .toml", f"write --out {out.with_suffix('.toml')}")
    if out.exists() and not overwrite:
        raise UsageProblem(f"--out {out}: is there already", "name another file, or add --overwrite")
    if len(files) > 1 and any(file.is_dir() for file in files):
        raise UsageProblem("a folder of text matrices is a vehicle by itself", "give it alone")
    text = text_matrices.as_toml(files[0], name or out.stem) if files[0].is_dir() else uuv_yaml.as_toml(files, name or out.stem)
    vehicle = parse(text, " + ".join(map(str, files)))
    write_text(out, text)
    document = _document(vehicle, out)
    if json_:
        output.result_json(document)
    else:
        output.result("\n".join(f"{key:<12} {value}" for key, value in document.items() if key not in ("schema", "notes")))
    for note in document["notes"]:
        output.say(f"  {note}", quiet)


def _document(vehicle: Vehicle, out: Path) -> dict[str, Any]:
    from rovval.vehicle.audit import uncontrolled_axes

    assumed = [f"{key}: {source}" for key, source in vehicle.sources.items() if source.startswith("assumed")]
    return {
        "schema": "rovval.vehicle_import/1",
        "file": str(out),
        "vehicle": vehicle.name,
        "hash": vehicle.hash,
        "mass_kg": vehicle.body.mass,
        "weight_n": round(vehicle.weight, 1),
        "buoyancy_n": round(vehicle.buoyancy, 1),
        "thrusters": len(vehicle.thruster),
        "not_pushed": ", ".join(uncontrolled_axes(vehicle)) or "none",
        "notes": [*vehicle.notes, *assumed],
    }

"""A dive as a German topside program exports it: a banner, semicolons, decimal commas, units in the header, a column of words."""

from __future__ import annotations

from pathlib import Path

GERMAN = "Export der Topside;Tauchgang 7\nDatum;Uhrzeit;Tiefe [m];Kurs [°];Vor [kn];Drehzahl_BB [1/min];Drehzahl_SB [1/min];Modus\n"


def german(path: Path, rows: int = 60, gap_at: int = 30) -> Path:
    """Date and time in two columns, heading over north, five seconds missing before row ``gap_at``."""
    late = [0.1 * i + (5.0 if i >= gap_at else 0.0) for i in range(rows)]
    values = [f"{2.5 + 0.01 * i};{(350 + i) % 360};{0.5 + 0.001 * i};{-1250.5 - i};{900 + i};{'HOLD' if i < 9 else 'DEPTH'}" for i in range(rows)]
    cells = [f"03.05.2024;14:03:{t:04.1f};{v}" for t, v in zip(late, values, strict=True)]
    path.write_text((GERMAN + "\n".join(cells) + "\n").replace(".", ",").replace("03,05,2024", "03.05.2024"), encoding="utf-8")
    return path

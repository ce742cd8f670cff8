"""One log given twice is found, whatever it is called; two dives of one vehicle are two."""

from dataclasses import replace

from report_cases import make_run

from rovval.alignment.duplicates import duplicates
from rovval.alignment.stretch import stretch_of


def test_a_copy_under_another_name_and_a_stretch_of_it_are_the_same_log():
    run = make_run(300)
    copy, part = replace(run, id="other", source="copy.csv", sha256="cd" * 32), stretch_of(run, 5.0, 20.0)
    assert duplicates([run, copy]) == [(0, 1)]
    assert duplicates([part, run]) == [(0, 1)]
    assert duplicates([run, part, copy]) == [(0, 1), (0, 2), (1, 2)]


def test_other_noise_makes_another_dive():
    run = make_run(300)
    values = {name: v + 1e-6 for name, v in run.values.items()}
    assert duplicates([run, replace(run, id="next", values=values)]) == []
    assert duplicates([stretch_of(run, 0.0, 10.0), stretch_of(run, 10.1, 20.0)]) == []

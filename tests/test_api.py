"""The Python API: light until it is used, the same whichever room was imported before, a page of everything it returns."""

import inspect
import subprocess
import sys

import pytest

import rovval
from rovval.core.errors import UsageProblem
from rovval.demo import sample

HEAVY = {"numpy", "scipy", "polars", "numba", "pydantic", "rerun", "typer", "jinja2"}


def test_importing_it_imports_nothing_else():
    code = "import sys, rovval; print(*{m.partition('.')[0] for m in sys.modules}, *(m for m in sys.modules if m.startswith('rovval.')))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert "rovval" in loaded
    assert {name for name in loaded if name.startswith("rovval.")} <= {"rovval.core", "rovval.core.version"}
    assert not HEAVY & loaded


@pytest.mark.parametrize("before", ["", "import rovval.diagnose.pipeline, rovval.fit", "from rovval.fit import FitResult"])
def test_functions_of_a_room_s_name_can_be_called_before_and_after_the_room_is_imported(before):
    code = f"import rovval\n{before}\ntry: rovval.diagnose([])\nexcept rovval.core.errors.UsageProblem as e: print(e)\n"
    code += "try: rovval.fit([], [])\nexcept rovval.core.errors.UsageProblem as e: print(e)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.count("no run was given") == 2


def test_a_room_of_a_function_s_name_stays_a_room():
    import rovval.diagnose.criteria as criteria
    import rovval.fit

    assert inspect.ismodule(criteria)
    assert inspect.ismodule(sys.modules["rovval.diagnose"])
    assert list(inspect.signature(rovval.diagnose).parameters)[:2] == ["runs", "vehicle"]


def test_every_function_says_what_it_does():
    for name in set(rovval.__all__) - {"__version__"}:
        function = getattr(rovval, name)
        assert callable(function)
        assert inspect.signature(function).return_annotation not in ("", inspect.Signature.empty)
        assert function.__doc__


def test_load_simulate_compare_and_their_pages(tmp_path):
    run = sample()
    sim = rovval.simulate(run, "merlin", effects=["inflow_loss:loss=0.3"])
    with_effect, without = rovval.compare(run, sim), rovval.compare(run)
    assert with_effect.windowed["surge"].rmse < 0.5 * without.windowed["surge"].rmse
    for result in (run, sim, with_effect):
        page = rovval.plot(result)
        assert page.save(tmp_path / "page.html").read_text(encoding="utf-8") == page.html
        assert page.html.startswith("<!doctype html>")
        assert "SYNTHETIC" in page.html or result is sim
        assert "run.rrd" not in page.html  # nothing lies beside it
        assert page._repr_html_().startswith("<iframe srcdoc=")


def test_what_has_no_page_is_refused():
    with pytest.raises(TypeError, match="no page of a int"):
        rovval.plot(3)  # type: ignore[arg-type]


def test_a_vehicle_that_does_not_exist_is_refused_by_name():
    with pytest.raises(UsageProblem, match="no vehicle named 'merlim'"):
        rovval.simulate(sample(), "merlim")


def test_a_mission_is_flown_and_its_run_is_one_like_any_other():
    from rovval.fly.mission import parse

    flight = rovval.fly(parse({"name": "brief", "vehicle": "merlin", "leg": [{"kind": "hold", "for_s": 3.0, "depth_m": 20.5}]}))
    assert rovval.compare(flight.run(), "merlin").free["heave"].rmse < 1e-3
    assert rovval.plot(flight).html.startswith("<!doctype html>")
    with pytest.raises(UsageProblem, match="no such mission"):
        rovval.fly("no_such_mission")

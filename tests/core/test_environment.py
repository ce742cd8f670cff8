"""Variables for processes that are started within, and nothing of them afterwards."""

import os
import subprocess
import sys

import pytest

from rovval.core.environment import environment


def test_what_is_started_within_finds_them_and_what_was_there_stands_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROVVAL_OF_BEFORE", "kept")
    monkeypatch.delenv("ROVVAL_NEW", raising=False)
    with pytest.raises(KeyError), environment({"ROVVAL_OF_BEFORE": "other", "ROVVAL_NEW": "1"}):
        code = "import os; print(os.environ['ROVVAL_OF_BEFORE'], os.environ['ROVVAL_NEW'])"
        said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        assert said.split() == ["other", "1"]
        raise KeyError
    assert os.environ["ROVVAL_OF_BEFORE"] == "kept" and "ROVVAL_NEW" not in os.environ

"""Lines that are longer than a terminal go on below their last column."""

from __future__ import annotations

from rovval.report.common.terminal import WIDTH, fitted


def test_words_go_on_below_the_last_column():
    row = "gap in surge      0.031 m/s  rises by 3 % [2, 4] a week since 4 May 2026 [27 Apr 2026 to 11 May 2026], at once with probability 0.62"
    first, *rest = fitted(row).split("\n")
    column = row.index("rises")
    assert len(first) <= WIDTH and rest and all(line[:column].isspace() and not line[column].isspace() and len(line) <= WIDTH for line in rest)
    assert " ".join(" ".join([first, *rest]).split()) == " ".join(row.split())


def test_a_sentence_goes_on_below_its_first_word():
    lines = fitted("  " + "word " * 30).split("\n")
    assert len(lines) == 2 and all(line.startswith("  word") for line in lines)


def test_a_column_far_right_has_no_room_for_words_below():
    row = f"{'a':<70}  four words and more of them"
    assert fitted(row).split("\n")[1].startswith("words") or fitted(row).split("\n")[1].startswith("four")


def test_what_fits_stays_and_a_path_is_not_cut():
    table = "a    1\nb    2\n\n"
    assert fitted(table) == table and fitted("x" * 90) == "x" * 90

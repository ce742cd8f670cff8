"""Words of the pages that a reader need not know, each in one sentence; docs/glossary.md has all terms, and where they come from."""

from __future__ import annotations

import re

TERMS = {
    "gap": "the simulated minus the measured motion, in short windows that each start from the measured state",
    "window": "a stretch of the log, 10 s as a rule, that is simulated from its measured first state",
    "rms": "root mean square: the size of an error that goes up and down",
    "sensor noise": "the error that the noise of the sensors alone makes; no simulator comes nearer",
    "held-out": "of data that the values under judgement were not fitted to",
    "interval": "the true value lies in it with a probability of 90 %, if the equations are right",
    "probability": "of one answer among all that were compared: a healthy vehicle, effects of the library, a file that is off, something else",
    "tolerance": "how far off a number may be: a healthy simulator's coefficient, as a standard deviation (--calibration-slop); an error (--fail-above)",
    "regime": "a part of the log with something in common: a range of speed, of turn rate, of depth, of a thruster's activity",
    "effect": "something that the simulator leaves out or has wrong",
    "evidence": "how much more likely the log is with an effect than without it: twice the natural logarithm of the ratio",
    "confusion group": "effects that this log cannot tell from one another",
    "IAE": "integral over time of the absolute error",
    "skill": "1 - MSE / MSE of predicting no motion: 1 is perfect, 0 no better than predicting none, below 0 worse",
    "free run": "one simulation from the log's first state to its end, in which errors add up",
}
SAID = ("th", "dt", "p", "li", "dd")  # elements whose words are ours
NOT_SAID = re.compile(r'scope="row"|class="(eyebrow|banner|log|value)"')  # of these, names and what a log says of itself
UNTOUCHED = ("a", "code")  # inside them: links already, and what is typed
_TAG = re.compile(r"(<[^>]*>)")
_NAME = re.compile(r"<(/?)(\w+)")
_LINKED = re.compile(r'<a class="term" href="#word-([^"]+)"')
_WORD = re.compile(rf"(?<![\w-])({'|'.join(re.escape(t) for t in sorted(TERMS, key=len, reverse=True))})(?=s?(?![\w-]))", re.IGNORECASE)
_NAMED = {term.lower(): term for term in TERMS}


def linked(html: str) -> str:
    """A page of which each section links every term, where it first stands in a sentence or heads a column or a value, to its meaning at the page's foot
    (`#word-TERM`)."""
    head, body, rest = html.partition("<body>")
    text, foot, words = rest.partition('<section id="words">')
    inside, untouched = False, 0
    known: set[str] = set()

    def link(found: re.Match[str]) -> str:
        term = _NAMED[found[1].lower()]
        if term in known:
            return found[0]
        known.add(term)
        return f'<a class="term" href="#word-{term.replace(" ", "-")}">{found[0]}</a>'

    parts = []
    for part in _TAG.split(text):
        if tag := _NAME.match(part):
            opens, name = not tag[1], tag[2]
            known = set() if part.startswith("<section") else known
            known |= {already[1].replace("-", " ") for already in [_LINKED.match(part)] if already}
            untouched += (1 if opens else -1) if name in UNTOUCHED else 0
            inside = opens and not NOT_SAID.search(part) if name in SAID else inside
        parts.append(_WORD.sub(link, part) if inside and not untouched and not part.startswith("<") else part)
    return "".join((head, body, *parts, foot, words))

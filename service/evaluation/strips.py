"""Queries beside their first answers, as HTML: what Figure 4 of the paper shows."""

from collections.abc import Mapping, Sequence
from html import escape

from service.evaluation.album import Album
from service.evaluation.outcome import Outcome, Question
from service.evaluation.scores import Scores, ranked

ANSWERS = 6  # of each query


def query_rows(
    outcome: Outcome,
    scores: Mapping[str, Scores],
    places: Sequence[int],
    methods: Sequence[str],
    album: Album,
) -> str:
    """Return the chosen queries, each with a strip of answers by every method given.

    Parameters
    ----------
    places : sequence of int
        Of the questions to show.
    """
    return "\n".join(
        f'<article class="query">{_asked(outcome.questions[k], album)}<div class="strips">'
        + "\n".join(_strip(outcome, method, k, int(scores[method].ranks[k]), album) for method in methods)
        + "</div></article>"
        for k in places
    )


def _asked(question: Question, album: Album) -> str:
    return (
        f'<div class="asked">{album.show(question.name)}'
        f"<p><b>{escape(question.transformation)}</b>, strength {question.strength}</p>"
        f'<p class="name">{escape(question.model)}</p></div>'
    )


def _strip(outcome: Outcome, method: str, place: int, rank: int, album: Album) -> str:
    """Return the first answers, and the right one where it comes later."""
    model = outcome.questions[place].model
    right = outcome.gallery.index(model)
    names = [outcome.gallery[k] for k in ranked(outcome.distances[method][place], right)[:ANSWERS]]
    answers = [_answer(number, name, _kind(number, rank), album) for number, name in enumerate(names, 1)]
    if rank > ANSWERS:
        answers.append(_answer(rank, model, "right later", album))
    return (
        f'<div class="strip"><p><code><b>{escape(method)}</b></code> {_told(rank)}</p>'
        f"<ol>{''.join(answers)}</ol></div>"
    )


def _told(rank: int) -> str:
    return "right at once" if rank == 1 else f"right answer at rank {rank}"


def _kind(number: int, rank: int) -> str:
    """Return the classes of the answer at a rank: wrong ones behind the right one are no mistakes."""
    if number == rank:
        return "right"
    return "wrong" if number < rank else "wrong after"


def _answer(rank: int, name: str, kind: str, album: Album) -> str:
    mark, word = ("✓", "right") if kind.startswith("right") else ("✗", "wrong")
    return (
        f'<li class="{kind}" value="{rank}"><span class="rank">{rank} <span aria-hidden="true">{mark}</span>'
        f'<span class="unseen">{word}</span></span>{album.show(name)}'
        f'<span class="name" title="{escape(name)}">{escape(name)}</span></li>'
    )

"""A method without each of its parts: what every part is worth."""

from dataclasses import replace

from index.methods import METHODS, Method
from service.evaluation.outcome import Outcome


def ablations(method: Method) -> list[Method]:
    """Return the method without its second stage, and without each block, with and without that stage."""
    bare = replace(method, name=f"{method.name}: first stage", refined=0)
    found = [bare] if method.refined else []
    for block in method.blocks:
        rest = tuple(other for other in method.blocks if other.name != block.name)
        found += [
            replace(version, name=f"{version.name}, no {block.name}", blocks=rest)
            for version in ([method, bare] if method.refined else [method])
        ]
    return found


def whole_methods(outcome: Outcome) -> Outcome:
    """Return an outcome of the table's own methods alone, where there is one: pages show no more."""
    whole = {name: distances for name, distances in outcome.distances.items() if name in METHODS}
    return replace(outcome, distances=whole or outcome.distances)

"""Pictures of queries and shapes, each drawn when it is asked for."""

from collections.abc import Iterator, Mapping, Sequence

from service.evaluation.describing import Setting
from service.evaluation.making import coloured, damaged
from service.evaluation.protocol import Recipe
from service.evaluation.sources import read_source
from service.evaluation.suites import Suite
from worker.errors import MeshError
from worker.geometry.repair import repair
from worker.pictures.thumbnail import thumbnail

SIDE = 160  # pixels


class Pictures(Mapping[str, bytes]):
    """Name of a query or a gallery entry → PNG; what is refused has none.

    Parameters
    ----------
    setting : Setting
        Where meshes are read from.
    tests : sequence of Suite
        Whose meshes can be asked for.
    """

    def __init__(self, setting: Setting, tests: Sequence[Suite]) -> None:
        self._folder = setting.folder
        self._recipes = {entry.name: entry.recipe for test in tests for entry in test.gallery}
        self._recipes |= {query.name: query.recipe for test in tests for query in test.queries}
        self._drawn: dict[str, bytes] = {}

    def __getitem__(self, name: str) -> bytes:
        if name not in self._drawn:
            try:
                self._drawn[name] = self._draw(self._recipes[name])
            except MeshError as error:
                raise KeyError(name) from error
        return self._drawn[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._recipes)

    def __len__(self) -> int:
        return len(self._recipes)

    def _draw(self, recipe: Recipe) -> bytes:
        geometry = recipe.geometry
        mesh = coloured(damaged(read_source(self._folder, geometry.source), geometry), recipe)
        return thumbnail(mesh, repair(mesh), SIDE)

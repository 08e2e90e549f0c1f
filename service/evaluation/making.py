"""From a recipe to a mesh."""

import hashlib

from service.evaluation.contacts import weld_contacts
from service.evaluation.damage import cut_away, punch_holes, stick_on_ball
from service.evaluation.photometric import recolour
from service.evaluation.protocol import BENT, PARTIAL, Geometry, Recipe, random_of
from service.evaluation.twins import make_twin
from worker.reading.mesh import Mesh


def damaged(source: Mesh, geometry: Geometry) -> Mesh:
    """Apply a geometry's damage to the mesh that it starts from."""
    random = random_of(geometry.model, geometry.damage, geometry.strength)
    if geometry.damage == BENT:
        welded = weld_contacts(source, geometry.strength, random)
        return punch_holes(welded, geometry.strength, random)
    if geometry.damage == PARTIAL:
        damage = cut_away if loses_part(geometry) else stick_on_ball
        return damage(source, geometry.strength, random)
    return source


def coloured(mesh: Mesh, recipe: Recipe) -> Mesh:
    """Apply a recipe's coat and changes of colour to its geometry."""
    if recipe.coat is not None:
        mesh = make_twin(mesh, recipe.geometry.model, recipe.coat)
    for change in recipe.changes:
        random = random_of(recipe.label, recipe.strength, change)
        mesh = recolour(mesh, change, recipe.strength, random)
    return mesh


def loses_part(geometry: Geometry) -> bool:
    """Half of the models lose a part at even strengths and carry a ball at odd ones, half the other way."""
    half = hashlib.sha256(geometry.model.encode()).digest()[0]
    return (half + geometry.strength) % 2 == 0

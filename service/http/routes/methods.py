"""The methods that rank."""

from fastapi import APIRouter

from index.methods import DEFAULT_METHOD, METHODS
from service.http.openapi import problems
from service.http.reasons import READING
from service.http.schemas import MethodModel, MethodsModel

router = APIRouter(tags=["search"])


@router.get("/methods", operation_id="listMethods", summary="The methods", responses=problems(*READING))
def list_methods() -> MethodsModel:
    """Return every method with its blocks and weights; own weights may name these blocks."""
    items = [MethodModel.of(method, default=method.name == DEFAULT_METHOD) for method in METHODS.values()]
    return MethodsModel(items=items)

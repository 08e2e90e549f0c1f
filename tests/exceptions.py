"""The exceptions of the program that carry a code, and those of them that no request meets."""

import importlib
import inspect
import pkgutil

import index
import service
from index.errors import (
    BadKeyName,
    BadWebhook,
    CatalogueError,
    DamagedExport,
    DamagedIndex,
    ExportRefused,
    KeyNotFound,
    LeaseLost,
    LibraryNotEmpty,
    NewerFormat,
    NoPgvector,
    UnknownDatabase,
    UnknownStorage,
    UnknownVocabulary,
    WebhookNotFound,
)

EXPORTS = {ExportRefused, DamagedExport, NewerFormat, LibraryNotEmpty}
# Never reach a request: they belong to workers, to indexes that are built anew, and to the command line.
INSIDE = {
    CatalogueError,
    LeaseLost,
    DamagedIndex,
    UnknownVocabulary,
    KeyNotFound,
    BadKeyName,
    WebhookNotFound,
    BadWebhook,
    UnknownDatabase,
    UnknownStorage,
    NoPgvector,
    *EXPORTS,
}


def exceptions_with_codes() -> set[type[Exception]]:
    """Return every exception class of service and index that carries a code."""
    found: set[type[Exception]] = set()
    for package in (service, index):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if ".commands" in module.name or ".migrations" in module.name or module.name.endswith("preload"):
                continue
            members = inspect.getmembers(importlib.import_module(module.name), inspect.isclass)
            found |= {
                each
                for _, each in members
                if issubclass(each, Exception)
                and isinstance(getattr(each, "code", None), str)
                and each.__module__.split(".")[0] in ("service", "index")
            }
    return found

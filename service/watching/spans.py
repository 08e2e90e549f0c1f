"""Where traces go: nowhere, unless an exporter is configured."""

import os
from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from typing import Protocol

from service.jobs.ended import EndedJob

Attributes = Mapping[str, str | int | float | bool]
ENDPOINTS = "OTEL_EXPORTER_OTLP_ENDPOINT", "OTEL_EXPORTER_OTLP_TRACES_ENDPOINT"  # OpenTelemetry's own names


class Request(Protocol):
    """The span of a request while it lasts."""

    trace_id: str | None  # 32 hexadecimal digits

    def answered(self, name: str, attributes: Attributes) -> None:
        """Name it by its route and say what came of it."""


class _NoRequest:
    trace_id: str | None = None

    def answered(self, name: str, attributes: Attributes) -> None:
        """Tell nobody."""


class Spans:
    """Tells nobody; `service.watching.tracing` tells a collector."""

    def inside(self, name: str, attributes: Attributes) -> AbstractContextManager[object]:  # noqa: ARG002
        """Return the context of a part of whatever is at work here."""
        return nullcontext()

    def request(self, headers: Mapping[str, str]) -> AbstractContextManager[Request]:  # noqa: ARG002
        """Return the context of a request, which goes on with the trace that its headers name."""
        return nullcontext(_NoRequest())

    def job(self, job: EndedJob) -> None:
        """Tell of a job that ended, with its stages."""

    def close(self) -> None:
        """Send what is not sent yet."""


def open_spans() -> Spans:
    """Return where traces go by OpenTelemetry's own environment variables; nothing is loaded without them."""
    disabled = os.environ.get("OTEL_SDK_DISABLED", "").lower() == "true"
    if disabled or not any(os.environ.get(name) for name in ENDPOINTS):
        return Spans()
    from service.watching.tracing import exported_spans  # heavy, and optional

    return exported_spans()

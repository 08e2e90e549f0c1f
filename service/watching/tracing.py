"""Traces for a collector that speaks OpenTelemetry's protocol; loaded only where one is configured."""

import contextlib
import threading
from collections.abc import Iterator, Mapping
from datetime import datetime
from importlib.metadata import version

from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
from opentelemetry.sdk.resources import OTELResourceDetector, Resource
from opentelemetry.sdk.trace import SpanProcessor, TracerProvider
from opentelemetry.sdk.trace.export import BatchSpanProcessor
from opentelemetry.trace import (
    Span,
    SpanKind,
    Status,
    StatusCode,
    Tracer,
    format_trace_id,
    set_span_in_context,
)
from opentelemetry.trace.propagation.tracecontext import TraceContextTextMapPropagator

from service.jobs.ended import EndedJob
from service.jobs.timing import Stage
from service.watching.spans import Attributes, Request, Spans

SERVICE = "faience"  # OTEL_SERVICE_NAME and OTEL_RESOURCE_ATTRIBUTES say otherwise
CLOSE_SECONDS = 5.0  # at the end, for spans that nobody took yet
SERVER_ERROR = 500


def exported_spans() -> Spans:
    """Return traces that go where OpenTelemetry's environment variables say, in the background."""
    return Traces(BatchSpanProcessor(OTLPSpanExporter()))


class Traces(Spans):
    """Spans of requests, of the stages of queries, and of jobs.

    Parameters
    ----------
    processor : SpanProcessor
        Takes the spans that ended.
    """

    def __init__(self, processor: SpanProcessor) -> None:
        own = Resource.create({"service.name": SERVICE, "service.version": version("faience")})
        resource = own.merge(OTELResourceDetector().detect())  # the environment's words go before ours
        self._provider = TracerProvider(resource=resource, shutdown_on_exit=False)
        self._provider.add_span_processor(processor)
        self._tracer: Tracer = self._provider.get_tracer(SERVICE)
        self._propagator = TraceContextTextMapPropagator()

    @contextlib.contextmanager
    def inside(self, name: str, attributes: Attributes) -> Iterator[None]:
        """Add a span below the current one."""
        with self._tracer.start_as_current_span(name, attributes=attributes):
            yield

    @contextlib.contextmanager
    def request(self, headers: Mapping[str, str]) -> Iterator[Request]:
        """Add a server's span, below the caller's where `traceparent` names one."""
        caller = self._propagator.extract(headers)
        with self._tracer.start_as_current_span("request", caller, SpanKind.SERVER) as span:
            yield _Request(span)

    def job(self, job: EndedJob) -> None:
        """Add a trace of its own, with a span for each stage."""
        attributes: dict[str, str | int] = {
            "faience.job_id": job.job.id,
            "faience.shape_id": job.job.shape_id,
            "faience.outcome": job.outcome,
            "faience.attempt": job.job.attempts,
        }
        root = self._tracer.start_span(
            "job", kind=SpanKind.CONSUMER, attributes=attributes, start_time=_nanoseconds(job.claimed_at)
        )
        for stage in job.stages:
            self._stage(root, stage)
        if job.outcome != "ready":
            root.set_status(Status(StatusCode.ERROR, job.outcome))
        root.end(_nanoseconds(job.ended_at))

    def close(self) -> None:
        """Send what is left; give up soon where nobody takes it."""
        closing = threading.Thread(target=self._provider.shutdown, daemon=True)
        closing.start()
        closing.join(CLOSE_SECONDS)

    def _stage(self, root: Span, stage: Stage) -> None:
        began = int(stage.began * 1e9)
        span = self._tracer.start_span(stage.name, set_span_in_context(root), start_time=began)
        span.end(began + int(stage.seconds * 1e9))


class _Request:
    def __init__(self, span: Span) -> None:
        self._span = span
        self.trace_id: str | None = format_trace_id(span.get_span_context().trace_id)

    def answered(self, name: str, attributes: Attributes) -> None:
        """Name it and say what came of it."""
        self._span.update_name(name)
        self._span.set_attributes(attributes)
        status = attributes.get("http.response.status_code")
        if isinstance(status, int) and status >= SERVER_ERROR:
            self._span.set_status(Status(StatusCode.ERROR))


def _nanoseconds(moment: datetime) -> int:
    return int(moment.timestamp() * 1e9)

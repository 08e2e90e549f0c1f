"""Traces go where they are asked for, whole, and nothing of them is loaded otherwise."""

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from datetime import timedelta
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest
from opentelemetry.proto.collector.trace.v1.trace_service_pb2 import ExportTraceServiceRequest
from opentelemetry.sdk.trace import ReadableSpan
from opentelemetry.sdk.trace.export import SimpleSpanProcessor
from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter
from opentelemetry.trace import StatusCode

from service.watching.tracing import Traces
from tests.fakes import coloured_triangle
from tests.serving import serving, settings_for, wait_until
from tests.test_jobs_seen import BEGAN, ENDED

CALLER = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"


@pytest.fixture
def memory() -> InMemorySpanExporter:
    return InMemorySpanExporter()


@pytest.fixture
def traces(memory: InMemorySpanExporter) -> Traces:
    return Traces(SimpleSpanProcessor(memory))


def named(spans: tuple[ReadableSpan, ...], name: str) -> ReadableSpan:
    (found,) = (span for span in spans if span.name == name)
    return found


def test_a_request_goes_on_with_its_callers_trace(traces: Traces, memory: InMemorySpanExporter) -> None:
    with traces.request({"traceparent": CALLER}) as span:
        assert span.trace_id == CALLER.split("-")[1]
        with traces.inside("rank", {"faience.method": "fused"}):
            pass
        span.answered("GET /v1/shapes", {"http.response.status_code": 503})
    spans = memory.get_finished_spans()
    request, rank = named(spans, "GET /v1/shapes"), named(spans, "rank")
    assert request.parent is not None
    assert f"{request.parent.span_id:016x}" == CALLER.split("-")[2]
    assert rank.parent is not None
    assert rank.parent == request.get_span_context()
    assert request.status.status_code is StatusCode.ERROR


def test_a_request_without_or_with_a_broken_caller_begins_a_trace(traces: Traces) -> None:
    made = set()
    for headers in ({}, {"traceparent": "nonsense"}, {"traceparent": "0" * 600}):
        with traces.request(headers) as span:
            made.add(span.trace_id)
    assert len(made) == 3


def test_a_job_is_a_trace_with_its_stages_at_their_times(
    traces: Traces, memory: InMemorySpanExporter
) -> None:
    traces.job(ENDED)
    spans = memory.get_finished_spans()
    root = named(spans, "job")
    assert root.attributes is not None
    assert root.attributes["faience.shape_id"] == "s"
    assert root.start_time == int(BEGAN.timestamp() * 1e9)
    assert root.end_time == int((BEGAN + timedelta(seconds=4)).timestamp() * 1e9)
    recording = named(spans, "recording")
    assert recording.parent == root.get_span_context()
    assert (recording.start_time, recording.end_time) == (5_000_000_000, 5_250_000_000)


class Collector(BaseHTTPRequestHandler):
    """Takes OpenTelemetry's protobuf over HTTP."""

    got: list[ExportTraceServiceRequest]

    def do_POST(self) -> None:
        """Keep what came."""
        body = self.rfile.read(int(self.headers["Content-Length"]))
        assert self.headers["Content-Type"] == "application/x-protobuf"
        self.got.append(ExportTraceServiceRequest.FromString(body))
        self.send_response(200)
        self.end_headers()

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture
def collector(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[ExportTraceServiceRequest]]:
    got: list[ExportTraceServiceRequest] = []
    server = HTTPServer(("127.0.0.1", 0), type("Own", (Collector,), {"got": got}))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    monkeypatch.setenv("OTEL_EXPORTER_OTLP_ENDPOINT", f"http://127.0.0.1:{server.server_port}")
    monkeypatch.setenv("OTEL_EXPORTER_OTLP_COMPRESSION", "none")
    monkeypatch.setenv("OTEL_SERVICE_NAME", "museum")
    yield got
    server.shutdown()
    server.server_close()
    thread.join()


def test_a_collector_gets_requests_queries_and_jobs(
    tmp_path: Path, collector: list[ExportTraceServiceRequest]
) -> None:
    with serving(settings_for(tmp_path)) as running:
        shape_id = running.add({"a.ply": coloured_triangle()}).json()["id"]
        answer = running.client.get(f"/v1/shapes/{shape_id}/similar", headers={"traceparent": CALLER})
        assert answer.status_code == 200
        wait_until(lambda: "faience_jobs_total" in running.client.get("/metrics").text)
    resources = [each for request in collector for each in request.resource_spans]
    names = {pair.key: pair.value.string_value for each in resources for pair in each.resource.attributes}
    assert names["service.name"] == "museum"
    spans = {span.name: span for each in resources for scope in each.scope_spans for span in scope.spans}
    query = spans["GET /v1/shapes/{shape_id}/similar"]
    assert query.trace_id.hex() == CALLER.split("-")[1]
    assert {"catch_up", "rank"} <= {
        span.name for span in spans.values() if span.parent_span_id == query.span_id
    }
    told = {pair.key: pair.value.string_value for pair in spans["job"].attributes}
    assert told["faience.shape_id"] == shape_id
    assert spans["recording"].parent_span_id == spans["job"].span_id


def test_nothing_of_the_sdk_is_loaded_where_nothing_is_configured() -> None:
    script = (
        "import os, sys; from service.watching.spans import Spans, open_spans; import service.server; "
        "assert type(open_spans()) is Spans; os.environ['OTEL_EXPORTER_OTLP_ENDPOINT'] = 'http://x'; "
        "os.environ['OTEL_SDK_DISABLED'] = 'true'; assert type(open_spans()) is Spans; "
        "print([name for name in sys.modules if name.startswith('opentelemetry.sdk')])"
    )
    clean = {name: value for name, value in os.environ.items() if not name.startswith("OTEL_")}
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, env=clean, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"

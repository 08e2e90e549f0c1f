"""What an operator may change, read from arguments and from the environment (``FAIENCE_…``)."""

from enum import StrEnum
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, SecretStr, field_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from index.key_secrets import digest_of
from service.jobs.cluster_address import checked_address


class IndexKind(StrEnum):
    """Where the vectors of searches are."""

    MEMORY = "memory"  # of each process
    PGVECTOR = "pgvector"  # in the catalogue's PostgreSQL; answers are proven
    PGVECTOR_HNSW = "pgvector-hnsw"  # there too, found by a graph; answers may lack a shape


class Settings(BaseSettings):
    """All settings, with defaults for one machine."""

    model_config = SettingsConfigDict(env_prefix="FAIENCE_", frozen=True)

    data_dir: Path = Path("faience-data")  # everything that is kept
    database_url: str | None = None  # SQLite inside data_dir where none is given
    storage_url: str | None = (
        None  # of the files: s3://BUCKET/PREFIX or file:///FOLDER; inside data_dir without
    )
    presigned: bool = False  # files in a bucket are fetched there, at an address that is good for a while
    index: IndexKind = IndexKind.MEMORY  # where searches find their vectors
    busy_seconds: float = Field(default=15, gt=0)  # that a change waits for another program's lock
    host: str = "127.0.0.1"
    port: int = Field(default=8000, ge=0, le=65535)
    api_keys: Annotated[tuple[SecretStr, ...], NoDecode] = ()  # beside the library's; separated by commas
    insecure: bool = False  # listen beyond this machine without keys
    uploads_per_minute: int = Field(default=600, ge=0)  # with one key; 0: as many as come

    max_body_bytes: int = Field(default=512 * 2**20, ge=1)  # of one upload
    max_files: int = Field(default=200, ge=1)  # of one upload
    max_field_bytes: int = Field(default=64 * 2**10, ge=1)  # of a text field
    body_idle_seconds: float = Field(default=30, gt=0)  # longest silence while a body is sent
    body_seconds: float = Field(default=900, gt=0)  # longest time for a whole body
    reserve_bytes: int = Field(default=64 * 2**20, ge=0)  # free space that uploads leave, for deletes

    workers: int = Field(default=2, ge=0)  # jobs at the same time; 0: no embedded worker
    job_memory_bytes: int = Field(default=4 * 2**30, ge=2**28)
    job_cpu_seconds: int = Field(default=300, ge=1)
    job_seconds: float = Field(default=600, gt=0)
    lease_seconds: float = Field(default=60, gt=0)  # after so long without a heartbeat a job is taken again
    poll_seconds: float = Field(default=0.5, gt=0)  # how often an idle worker looks for jobs
    cluster: str | None = None  # tcp://HOST:PORT of a Dask scheduler that has the jobs computed
    search_slots: int = Field(default=2, ge=1)  # meshes of `search` described at the same time
    search_queue: int = Field(default=8, ge=0)  # others that may wait; more are told to come back

    log: Literal["text", "json"] = "text"  # lines for people, or one JSON object a line
    metrics_port: int | None = Field(default=None, ge=0, le=65535)  # of a worker without an API
    drain_seconds: float = Field(default=0, ge=0)  # of service after a signal, while /readyz says no
    finish_seconds: float = Field(default=0, ge=0)  # in which running jobs may end after a signal

    @field_validator("api_keys", mode="before")
    @classmethod
    def _split_keys(cls, value: object) -> object:
        if isinstance(value, str):
            return tuple(key.strip() for key in value.split(",") if key.strip())
        return value

    @field_validator("cluster")
    @classmethod
    def _check_cluster(cls, value: str | None) -> str | None:
        return None if value is None else checked_address(value)

    @property
    def url(self) -> str:
        """SQLAlchemy address of the catalogue."""
        return self.database_url or f"sqlite:///{(self.data_dir / 'catalogue.sqlite3').resolve()}"

    @property
    def key_digests(self) -> tuple[bytes, ...]:
        """SHA-256 of each API key: what requests are compared with."""
        return tuple(digest_of(key.get_secret_value().encode()) for key in self.api_keys)


def is_loopback(host: str) -> bool:
    """Return whether only this machine reaches ``host``."""
    if host == "localhost":
        return True
    try:
        return ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False

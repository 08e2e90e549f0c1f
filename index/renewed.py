"""What came of describing a shape anew, as a row beside the description that it answers with."""

from collections.abc import Mapping
from typing import Any

from sqlalchemy.orm import Session

from index.tables import RenewalRow


def keep_renewal(session: Session, shape_id: str, fingerprint: str, facts: Mapping[str, Any]) -> None:
    """Note that a shape has a description by these parameters, and what it says of the mesh."""
    session.merge(
        RenewalRow(
            shape_id=shape_id,
            fingerprint=fingerprint,
            facts=dict(facts),
            error_code=None,
            error_detail=None,
        )
    )


def keep_failure(session: Session, shape_id: str, fingerprint: str, code: str, detail: str) -> None:
    """Note why a shape has none."""
    session.merge(
        RenewalRow(
            shape_id=shape_id,
            fingerprint=fingerprint,
            facts=None,
            error_code=code,
            error_detail=detail,
        )
    )

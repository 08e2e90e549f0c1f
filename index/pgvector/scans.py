"""Scans: what PostgreSQL computes of every row, and what follows from it about the exact distance.

For kept vectors v of a row and q of a query, that keeping moved by at most e_v and e_q in each block,

    Σ_b F_b max(0, ‖v_b − q_b‖₁ − e_v,b − e_q,b)^p,    F_b = w_b u_b^p / f_b^p,

never exceeds the distance; see `index.pgvector.form`. PostgreSQL adds in single precision, which rounds by a
known part of the sum. With the method's own weights and p = 1 one sum over all blocks says the same, and is
quicker.
"""

from dataclasses import dataclass

import numpy as np
from psycopg import sql

from index.arrays import DoubleArray, RowArray
from index.methods import Method
from index.pgvector.copying import literal
from index.pgvector.form import Form

MARGIN = 1e-9  # relative, of sums in double precision


@dataclass(frozen=True, kw_only=True)
class Scan:
    """A number that is computed of every row: the distance is at least (number − slack) · rate, and 0."""

    number: sql.Composable  # in SQL; the larger, the farther
    values: dict[str, str]  # its parameters
    slack: float
    rate: float

    def least(self, number: float) -> float:
        """Return the least distance of rows with this number or a larger one."""
        return max(0.0, (number - self.slack) * self.rate) * (1.0 - MARGIN)

    def reach(self, distance: float) -> float:
        """Return the largest number of rows that are within a distance."""
        return distance / self.rate * (1.0 + 2 * MARGIN) + self.slack


def scan_for(form: Form, method: Method, query: RowArray, errors: DoubleArray) -> Scan:
    """Return the scan for a query.

    Parameters
    ----------
    form : Form
        Of the table.
    method : Method
        The table's, perhaps with other weights.
    query : (width,) array
        As the layout keeps it.
    errors : (B,) array
        By which keeping moved any row of the table at most.
    """
    kept = form.kept(query[None])
    moved = errors + form.errors(query[None], kept)[0]
    rounded = 1.0 / (1.0 + _rounding(form))
    own = method.blocks == form.layout.method.blocks
    if own and method.power == 1:
        return _whole(form, literal(kept[0]), moved, rounded)
    weights = form.layout.weights(method) / (form.scale * form.worth) ** method.power  # (B,)
    return _by_block(form, method.power, kept[0], weights, moved / rounded)


def vector_literal(form: Form, query: RowArray) -> str:
    """Return a query (width,) as the table keeps rows, as it is written in a statement."""
    return literal(form.kept(query[None])[0])


def _whole(form: Form, query: str, moved: DoubleArray, rounded: float) -> Scan:
    # a function, not the operator: no index is asked, which would leave rows out
    number = sql.SQL("l1_distance(vector, %(whole)s::{})").format(sql.SQL(form.column))
    slack = float(moved.sum()) / rounded
    return Scan(number=number, values={"whole": query}, slack=slack, rate=rounded / form.scale)


def _by_block(form: Form, power: int, query: RowArray, weights: DoubleArray, slacks: DoubleArray) -> Scan:
    """Add up bounds block by block; ‖·‖₁ and slacks are of the same rounding, which `rate` takes off."""
    kind = sql.SQL("halfvec" if form.halves else "vector")
    edges = form.layout.edges.tolist()
    terms, values = [], {}
    for block in np.flatnonzero(weights).tolist():
        start, end = edges[block], edges[block + 1]
        values[f"block{block}"] = literal(query[start:end])
        part = sql.SQL("l1_distance(subvector(vector, {}, {}), {}::{})").format(
            sql.Literal(start + 1), sql.Literal(end - start), sql.Placeholder(f"block{block}"), kind
        )
        bound = sql.SQL("greatest(0.0::float8, {} - {}::float8)").format(part, _real(slacks[block]))
        terms.append(
            sql.SQL("{}::float8 * power({}, {})").format(_real(weights[block]), bound, sql.Literal(power))
        )
    rate = (1.0 / (1.0 + _rounding(form))) ** power
    return Scan(number=sql.SQL(" + ").join(terms), values=values, slack=0.0, rate=rate)


def _rounding(form: Form) -> float:
    """Return the part of a sum by which adding it in single precision may round it, at most."""
    return (form.layout.width + 8) * 2 * float(np.finfo(np.float32).eps)


def _real(value: float) -> sql.Literal:
    return sql.Literal(float(value))

"""Binary PLY bodies. Rows of equal length are read at once, mixed ones after a walk over their lengths."""

import struct
from array import array

import numpy as np

from worker.arrays import ByteArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.ply_columns import Body, Lists, Table, check_counts, positions, truncated
from worker.reading.ply_header import Element, Header

_FORMATS = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}


def read_binary(data: bytes, header: Header) -> Body:
    """Read the tables of a binary file.

    Raises
    ------
    MeshError
        TRUNCATED, TRAILING_DATA, BAD_DATA
    """
    body: Body = {}
    position = header.body
    with np.errstate(invalid="ignore"):  # NaN of any kind is for the caller to judge
        for element in header.elements:
            body[element.name], position = _read_table(data, position, element, header.byte_order)
    if position < len(data):
        raise MeshError(
            Code.TRAILING_DATA,
            f"The file goes on for {len(data) - position:,} bytes after the end that its header announces.",
        )
    return body


def _read_table(data: bytes, start: int, element: Element, order: str) -> tuple[Table, int]:
    lengths = _lengths_of_first(data, start, element, order)
    row = _row_type(element, order, lengths)
    end = start + element.count * row.itemsize
    if end <= len(data):
        rows = np.frombuffer(data, dtype=row, count=element.count, offset=start)
        if all((rows[f"count{place}"] == length).all() for place, length in lengths.items()):
            return _equal_rows(rows, element, lengths), end
    if not lengths:
        raise truncated(element, (len(data) - start) // row.itemsize)
    return _mixed_rows(data, start, element, order, would_fit=end == len(data))


def _row_type(element: Element, order: str, lengths: dict[int, int]) -> np.dtype[np.void]:
    """Return the type of a row whose lists have the given lengths."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for place, field in enumerate(element.properties):
        if field.count_type is None:
            fields.append((f"value{place}", order + field.type))
        else:
            fields.append((f"count{place}", order + field.count_type))
            fields.append((f"value{place}", order + field.type, (lengths[place],)))
    return np.dtype(fields)


def _lengths_of_first(data: bytes, start: int, element: Element, order: str) -> dict[int, int]:
    """Return the list lengths of the first row, by the property's place."""
    places = [place for place, field in enumerate(element.properties) if field.count_type]
    if not element.count:
        return dict.fromkeys(places, 0)
    first = Element(name=element.name, count=1, properties=element.properties)
    counts, _ = _walk(data, start, first, order)
    return {place: int(counts[place, 0]) for place in places}


def _equal_rows(rows: np.ndarray, element: Element, lengths: dict[int, int]) -> Table:
    scalars, lists = {}, {}
    for place, field in enumerate(element.properties):
        values: FloatArray = rows[f"value{place}"].astype(np.float64)
        if field.count_type is None:
            scalars[field.name] = values
        else:
            counts = np.full(element.count, lengths[place], dtype=np.int64)
            lists[field.name] = Lists(values=values.reshape(-1), counts=counts)
    return Table(scalars=scalars, lists=lists)


def _mixed_rows(
    data: bytes, start: int, element: Element, order: str, *, would_fit: bool
) -> tuple[Table, int]:
    """Read rows of mixed lengths; `would_fit` says that the file's size fits rows like the first alone."""
    try:
        counts, end = _walk(data, start, element, order)
    except MeshError as error:
        if would_fit and error.code == Code.TRUNCATED:
            raise _contradicted(element) from None
        raise
    if would_fit and end != len(data):
        raise _contradicted(element)
    return _gather_table(data, start, element, order, counts), end


def _contradicted(element: Element) -> MeshError:
    return MeshError(
        Code.BAD_DATA,
        f"The file's size fits {element.count:,} {element.name}s that are all as long as the first, "
        "but some announce another length.",
    )


def _gather_table(data: bytes, start: int, element: Element, order: str, counts: IntArray) -> Table:
    source = np.frombuffer(data, dtype=np.uint8)
    heads = np.array([int((field.count_type or "u0")[1]) for field in element.properties])[:, None]
    items = np.array([int(field.type[1]) for field in element.properties])[:, None]
    sizes = heads + counts * items  # (n_properties, n)
    ends = start + np.cumsum(sizes.T).reshape(sizes.T.shape).T
    starts = ends - counts * items  # of each property's first value
    scalars, lists = {}, {}
    for place, field in enumerate(element.properties):
        if field.count_type is None:
            scalars[field.name] = _gather(source, starts[place], order + field.type)
        else:
            item = positions(np.zeros_like(counts[place]), counts[place]) * int(field.type[1])
            item += np.repeat(starts[place], counts[place])
            lists[field.name] = Lists(values=_gather(source, item, order + field.type), counts=counts[place])
    return Table(scalars=scalars, lists=lists)


def _walk(data: bytes, position: int, element: Element, order: str) -> tuple[IntArray, int]:
    """Step from list to list.

    Returns
    -------
    counts : IntArray
        (n_properties, n) values of each property in each row; 1 where it is no list.
    end : int
        Where the last row ends.
    """
    steps, tail = _steps(element, order)
    found = [array("q") for _ in steps]
    size = len(data)
    for row in range(element.count):
        for (skip, head, item), column in zip(steps, found, strict=True):
            position += skip
            if position + head.size > size:
                raise truncated(element, row)
            count = data[position] if head.format == "B" else head.unpack_from(data, position)[0]
            if count < 0:
                check_counts(np.array([count]), element, row)
            column.append(count)
            position += head.size + count * item
        position += tail
        if position > size:
            raise truncated(element, row)
    counts = np.ones((len(element.properties), element.count), dtype=np.int64)
    places = [place for place, field in enumerate(element.properties) if field.count_type]
    for place, column in zip(places, found, strict=True):
        counts[place] = column
    return counts, position


def _steps(element: Element, order: str) -> tuple[list[tuple[int, struct.Struct, int]], int]:
    """Return each list's bytes before it, its length's form and its items' size; the bytes after the last."""
    steps = []
    skip = 0
    for field in element.properties:
        if field.count_type is None:
            skip += int(field.type[1])
        else:
            kind = _FORMATS[field.count_type]
            steps.append((skip, struct.Struct(kind if kind in "bB" else order + kind), int(field.type[1])))
            skip = 0
    return steps, skip


def _gather(source: ByteArray, starts: IntArray, kind: str) -> FloatArray:
    """Read values that begin anywhere: starts (k,) → (k,)."""
    size = np.dtype(kind).itemsize
    found = np.empty((starts.size, size), dtype=np.uint8)
    for byte in range(size):
        found[:, byte] = source[starts + byte]
    return found.view(kind).reshape(-1).astype(np.float64)

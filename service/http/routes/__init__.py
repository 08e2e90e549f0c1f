"""The calls of the HTTP interface: parse, one use case, a schema."""

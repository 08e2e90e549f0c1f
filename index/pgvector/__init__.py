"""Vectors in PostgreSQL, by its extension pgvector: search beyond one memory."""

"""Bytes in, numbers out: reading meshes and computing their descriptors. Pure."""

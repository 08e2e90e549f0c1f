"""What is kept, and how it is found. Arrays, ids and rows; no meshes, no web."""

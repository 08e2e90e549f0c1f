"""What came in, read: files and archives become one `Mesh`."""

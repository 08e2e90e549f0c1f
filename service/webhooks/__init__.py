"""Other programs are told when a shape is ready or failed."""

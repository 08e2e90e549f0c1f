"""What a person sees of a shape: a shaded picture, and a small mesh for a viewer."""

"""Why an answer cannot be explained."""


class NotExplained(Exception):
    """What the method compares, or this shape, has no places on the surface to show."""

    code = "not_explained"

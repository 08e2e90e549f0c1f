"""How many files and connections this process may have open."""

import resource

WANTED = 8192  # connections, the files that uploads on them write, the database


def raise_file_limit() -> None:
    """Take as many as are wanted, where the system's own limit allows it: shells often give 1024."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = WANTED if hard == resource.RLIM_INFINITY else min(WANTED, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


def file_limit() -> int:
    """Return how many this process may have open; WANTED where there is no limit."""
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return WANTED if soft == resource.RLIM_INFINITY else soft

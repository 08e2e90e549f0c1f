from service.jobs.rehearsal import rehearse


def test_a_rehearsal_ends_well() -> None:
    rehearse()  # the fork server does not tell

"""Loaded once by the fork server, so that every child starts warm and single-threaded.

Importing it is its purpose: the thread limits must stand before numpy is imported, and the import of
`worker.describe` is what a child would otherwise wait for. Nothing else imports this module.
"""

import os

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"):
    os.environ[_variable] = "1"

__import__("service.jobs.describing")

"""Loaded once by the fork server, so that every child starts warm and single-threaded.

Importing it is its purpose: the thread limits must stand before numpy is imported, and what a child would
otherwise wait for is imported, compiled and loaded here. Nothing else imports this module.
"""

import contextlib
import gc
import os

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"):
    os.environ[_variable] = "1"

__import__("service.jobs.describing")

with contextlib.suppress(Exception):  # whatever is wrong is told by the first job, not by the fork server
    __import__("service.jobs.rehearsal", fromlist=["rehearse"]).rehearse()
gc.collect()
gc.freeze()  # children do not touch, and so do not copy, what stays for ever

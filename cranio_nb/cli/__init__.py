"""The command line, one file a command."""

import os

# before numpy is loaded: the systems solved are small, and a second thread of BLAS waits longer than it works
for _name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

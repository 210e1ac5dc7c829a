"""cranio_nb: from a head CT with a hole in the skull to the prosthesis that closes it.

A teaching and research tool. Not a medical device.
"""

__version__ = "0.1.0"

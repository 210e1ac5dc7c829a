"""The independent witness: synthetic heads with known truth. Imports nothing from cranio_nb."""

"""The command line as `python -m cranio_nb`, for where the script `cranio-nb` is not on the path."""

from .cli.main import main

if __name__ == "__main__":
    main(prog_name="cranio-nb")

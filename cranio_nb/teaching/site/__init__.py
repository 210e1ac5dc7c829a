"""The lessons, the docs and the API as a web site that needs no kernel, no server and no network."""

"""What the maker of an implant asks of a patch: its mass, a way in, room to fit."""

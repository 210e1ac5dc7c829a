"""What a workshop asks of a patch: mass, a way in, room to fit."""

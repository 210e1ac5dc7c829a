"""Ways to design a prosthesis: each yields a `Piece` for each opening, and `design` makes a `Prosthesis` of them."""

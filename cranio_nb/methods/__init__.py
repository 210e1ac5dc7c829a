"""Ways to design a prosthesis, all behind the same door: bone mask in -> `Prosthesis` out."""

"""D-NURBS (Qin and Terzopoulos 1996): two elastic sheets across the hole."""

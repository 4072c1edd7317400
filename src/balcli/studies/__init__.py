"""An engine file and what varies in, figures of many variants out."""

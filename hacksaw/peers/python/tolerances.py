"""The relative tolerances that solvers run with, as those in Rust do."""


def three_a_decade(exponents):
    """1, 1/2 and 1/5 of 10 to each negative exponent."""
    return [part * 10.0**-k for k in exponents for part in (1.0, 0.5, 0.2)]

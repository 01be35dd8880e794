"""6.2: data transfer."""

from .define import value


@value("MOV", "S:INT -> D:INT+SD", steps=5, section="6.2.1")
@value("DMOV", "S:DINT -> D:DINT+SD", steps=7, section="6.2.2")
def mov(s):
    """D = S."""
    return s

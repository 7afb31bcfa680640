"""Texts that several files of tests load."""

SWING = """
/// A mass on a spring.
graph Swing {
    param mass: kg = 2, above 0;
    param stiffness: N/m = 50;
    1 slide: translation;
    I body = mass; C spring = stiffness start 0.1;
    slide -> body; slide -> spring;
    observe { x: m = spring.q; v: m/s = slide.flow }
}
"""

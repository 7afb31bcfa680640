"""Mechanisms as text: multibond graphs that run without a toolchain.

>>> import bond_graph as bg
>>> saw = bg.load("saw.bond")              # also a robot (.urdf, .xml) or a Rust file with bond_graph! (.rs)
>>> swing = bg.compile('''
... graph Swing {
...     param mass: kg = 2; param stiffness: N/m = 50;
...     1 slide: translation;
...     I body = mass; C spring = stiffness start 0.1;
...     slide -> body; slide -> spring;
...     observe { x: m = spring.q; v: m/s = slide.flow }
... }''')
>>> run = swing.run(t_end=2, mass=1.5)
>>> run["x"]                               # a NumPy array, for the times run["t"] in s
>>> run.to_pandas()                        # with the time as index; to_polars() likewise
>>> swing.plot("v over x", t_end=2)        # a picture in a notebook; .save("phase.svg")

Parameters have SI units: ``swing.parameters()`` has their names, units and ranges. Faults of a text raise ``FaultError``, which shows
each at its place; what cannot be raises ``ValueError`` with a sentence, a run that stops before its end ``RunFailed``.
"""

from ._bond_graph import FaultError, Model, Page, Picture, RunFailed, Table, __version__, compile, load

# What messages, `help` and pickle call them.
for _class in (FaultError, Model, Page, Picture, RunFailed, Table):
    _class.__module__ = __name__

__all__ = ["FaultError", "Model", "Page", "Picture", "RunFailed", "Table", "__version__", "compile", "load"]

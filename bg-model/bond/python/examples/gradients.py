"""Gradients of a run in a search by SciPy and in a function of JAX.

    python examples/gradients.py
"""

import bond_graph as bg
import numpy as np

SWING = bg.compile("""
graph Swing {
    param mass: kg = 2, above 0;
    param stiffness: N/m = 50, above 0;
    1 slide: translation;
    I body = mass; C spring = stiffness start 0.1;
    slide -> body; slide -> spring;
    observe { x: m = spring.q }
}
""")
NAMES = ["mass", "stiffness"]


def end(values):
    """Where the mass is after 1 s, m, and how that depends on the parameters."""
    parameters = dict(zip(NAMES, map(float, values)))
    value, slopes = SWING.gradient("x", t_end=1, rtol=1e-10, by=NAMES, **parameters)
    return value, np.array([slopes[name] for name in NAMES])


def by_scipy(goal=-0.05):
    """The parameters near the defaults with which the mass is at `goal`, m, after 1 s."""
    from scipy.optimize import minimize

    def missed(values):
        x, slopes = end(values)
        return (x - goal) ** 2, 2 * (x - goal) * slopes

    return minimize(missed, [2.0, 50.0], jac=True, bounds=[(0.5, 10), (10, 200)], tol=1e-14)


def by_jax():
    """The same number as a function that JAX differentiates, with what it is part of."""
    import jax

    jax.config.update("jax_enable_x64", True)
    shape = (jax.ShapeDtypeStruct((), "float64"), jax.ShapeDtypeStruct((len(NAMES),), "float64"))

    def called(values):
        value, slopes = end(values)
        return np.float64(value), slopes

    @jax.custom_vjp
    def x(values):
        return jax.pure_callback(called, shape, values)[0]

    def forward(values):
        return jax.pure_callback(called, shape, values)

    x.defvjp(forward, lambda slopes, change: (change * slopes,))
    return x


if __name__ == "__main__":
    found = by_scipy()
    print(f"scipy: mass {found.x[0]:.4f} kg, stiffness {found.x[1]:.3f} N/m, {found.nfev} runs, x {end(found.x)[0]:.6f} m")
    try:
        import jax
    except ImportError:
        print("jax: not installed")
    else:
        x = by_jax()
        energy = jax.grad(lambda values: values[1] * x(values) ** 2 / 2)
        print("jax: d(energy of the spring)/d(mass, stiffness)", energy(jax.numpy.array([2.0, 50.0])))

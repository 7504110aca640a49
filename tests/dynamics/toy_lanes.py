"""A kernel of lanes in the form of the real one, for the tests of how such a kernel is compiled."""

from rocking_cli.dynamics.calling import KernelSet

W = 8
SOURCE = []
"""The functions to compile."""


def called(function):
    SOURCE.append(function)
    return function


@called
def force(q, push):
    """A pendulum by its series."""
    z = q * q
    sine = q * (1.0 + z * (-1 / 6 + z * (1 / 120 + z * (-1 / 5040 + z / 362880))))
    return push * (1.0 + z * (-0.5 + z * (1 / 24 - z / 720))) - sine


@called
def run(memory, moved, steps):
    """Steps of Runge and Kutta, which halve where they go too far."""
    for _ in range(steps):
        for i in range(W):
            q = memory[i]
            w = memory[W + i]
            h = memory[2 * W + i]
            push = memory[3 * W + i]
            peak = memory[4 * W + i]
            k1 = force(q, push)
            k2 = force(q + 0.5 * h * w, push)
            k3 = force(q + 0.5 * h * w + 0.25 * h * h * k1, push)
            k4 = force(q + h * w + 0.5 * h * h * k2, push)
            q1 = q + h * w + h * h / 6 * (k1 + k2 + k3)
            w1 = w + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            go = (abs(k4 - k1) <= 0.1 * max(abs(k1), abs(k4))) & (q1 < 2.0)
            memory[5 * W + i] = q1 if go else q
            memory[6 * W + i] = w1 if go else w
            memory[7 * W + i] = max(peak, q1) if go else peak
            memory[8 * W + i] = 1.0 if go else 0.0
        for i in range(W):
            memory[i], memory[W + i], memory[4 * W + i] = memory[5 * W + i], memory[6 * W + i], memory[7 * W + i]
            if memory[8 * W + i] == 1.0:
                moved[i] += 1
            else:
                memory[2 * W + i] *= 0.5


TOY = KernelSet("toy", __name__, "run", ("R1", "I1", "i"), lanes=True)


@called
def serial(memory):
    """Each lane needs the one before it."""
    for i in range(1, 64):
        memory[i] = 0.5 * memory[i - 1] + memory[i]


SERIAL = KernelSet("serial", __name__, "serial", ("R1",), lanes=True)

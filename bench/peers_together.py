# SPDX-License-Identifier: MIT
"""MuJoCo as a peer of bench_together: lines of equal elastic balls that touch, the first of which comes with speed 1.

    python3 bench/peers_together.py

Uses the mujoco that the Python at hand has; without it that is said, and nothing measured. Columns as bench_together's:
the case; contacts; who; work (time steps); the largest error of a velocity; CPU time, us. MuJoCo's contacts are springs
(solref = "-k 0", no damping) that ask for accelerations, k times the indentation, all solved together; the speeds after
linear springs that push, not ask, are found here by Runge and Kutta's steps.
"""
import sys
import time

MODEL = """<mujoco>
<option timestep="%g" gravity="0 0 0" integrator="implicitfast" tolerance="1e-14" iterations="200" cone="elliptic"/>
<default><geom type="sphere" size="1" mass="1" condim="1" solref="-%g 0" solimp="0.999 0.999 1" margin="0"/>
<joint type="slide" axis="1 0 0"/></default><worldbody>%s</worldbody></mujoco>"""


def springs(n):
    """Speeds of n balls after linear springs of stiffness 1, to about 1e-11."""
    x, v, h = [0.0] * n, [1.0] + [0.0] * (n - 1), 1e-3

    def rates(y):
        force = [max(0.0, y[i] - y[i + 1]) for i in range(n - 1)]
        return [(force[i - 1] if i > 0 else 0) - (force[i] if i < n - 1 else 0) for i in range(n)]

    def over():
        return all(x[i] <= x[i + 1] and v[i] <= v[i + 1] for i in range(n - 1))

    while x[0] == 0 or not over():
        a1 = rates(x)
        a2 = rates([x[i] + h / 2 * v[i] for i in range(n)])
        a3 = rates([x[i] + h / 2 * v[i] + h * h / 4 * a1[i] for i in range(n)])
        a4 = rates([x[i] + h * v[i] + h * h / 2 * a2[i] for i in range(n)])
        x = [x[i] + h * v[i] + h * h / 6 * (a1[i] + a2[i] + a3[i]) for i in range(n)]
        v = [v[i] + h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]) for i in range(n)]
    return v


def measure(mujoco, n, stiffness, step):
    bodies = "".join('<body pos="%d 0 0"><joint/><geom/></body>' % (2 * i) for i in range(n))
    model = mujoco.MjModel.from_xml_string(MODEL % (step, stiffness, bodies))
    data = mujoco.MjData(model)
    data.qvel[0] = 1
    steps, begun = 0, time.process_time()
    mujoco.mj_step(model, data)
    def parted():
        return data.ncon == 0 and all(data.qvel[i] <= data.qvel[i + 1] + 1e-9 for i in range(n - 1))

    while steps < 2000000 and not parted():
        mujoco.mj_step(model, data)
        steps += 1
    return steps, list(data.qvel), time.process_time() - begun


def main():
    try:
        import mujoco
    except ImportError:
        print("peers_together: mujoco is not installed and is skipped", file=sys.stderr)
        return
    print("case,contacts,who,work,error,us")
    for n in (3, 11):
        wanted = springs(n)
        for stiffness, step in ((1e4, 1e-3), (1e4, 1e-4), (1e6, 1e-5)):
            steps, speed, seconds = measure(mujoco, n, stiffness, step)
            error = max(abs(a - b) for a, b in zip(speed, wanted))
            print("line linear,%d,MuJoCo %s,%d,%.2g,%.4g" % (n - 1, mujoco.__version__, steps, error, 1e6 * seconds))


main()

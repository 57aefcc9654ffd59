# SPDX-License-Identifier: MIT
"""coal and MuJoCo as peers of bench_gap, on the same ellipsoid pairs.

    build/bench/bench_gap --cases > cases.csv
    python3 bench/peers_gap.py cases.csv

Uses what the Python at hand has of coal, mujoco and numpy; what is missing is skipped with a line. Same columns as
bench_gap; the time includes the binding's cost of one call. MuJoCo's mj_geomDistance is called with the poses already set.
"""
import csv
import math
import sys
import time

HEADER = "family,kind,method,setting,time_us,gap_p50,gap_p99,gap_worst,normal_p50,unanswered"


def read_cases(path):
    cases = []
    with open(path, newline="") as file:
        for row in csv.reader(file):
            v = [float(x) for x in row]
            bodies = [(v[i:i + 3], v[i + 3:i + 6], v[i + 6:i + 10]) for i in (0, 10)]
            cases.append((bodies, v[20], v[21:24], v[24]))
    return cases


def quantile(values, q):
    values = sorted(values)
    return values[int(q * (len(values) - 1))] if values else math.nan


def report(name, setting, times, gaps, normals, unanswered, count):
    worst = max(gaps) if gaps else math.nan
    print(f"ellipsoid,separated,{name},{setting:g},{quantile(times, 0.5) * 1e6:.3g},{quantile(gaps, 0.5):.2g},"
          f"{quantile(gaps, 0.99):.2g},{worst:.2g},{quantile(normals, 0.5):.2g},{unanswered / count:.4f}", flush=True)


def run_coal(cases):
    try:
        import coal
        import numpy
    except ImportError as missing:
        print(f"# coal: skipped ({missing})")
        return
    prepared = []
    for bodies, gap, normal, reach in cases:
        shapes = [coal.Ellipsoid(*axes) for axes, _, _ in bodies]
        places = []
        for _, p, (w, x, y, z) in bodies:
            rotation = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
            places.append(coal.Transform3s(rotation, numpy.array(p)))
        prepared.append((shapes, places, gap, normal, reach))
    for tolerance in (1e-6, 1e-12):
        request = coal.DistanceRequest()
        request.gjk_tolerance = tolerance
        request.gjk_max_iterations = 1000
        times, gaps, normals = [], [], []
        for shapes, places, gap, normal, reach in prepared:
            result = coal.DistanceResult()
            start = time.perf_counter()
            distance = coal.distance(shapes[0], places[0], shapes[1], places[1], request, result)
            times.append(time.perf_counter() - start)
            gaps.append(abs(distance - gap) / reach)
            got = numpy.array(result.normal)
            normals.append(min(numpy.linalg.norm(got - normal), numpy.linalg.norm(got + normal)))
        report("coal", tolerance, times, gaps, normals, 0, len(cases))


def run_mujoco(cases):
    try:
        import mujoco
        import numpy
    except ImportError as missing:
        print(f"# mujoco: skipped ({missing})")
        return
    xml = """<mujoco><worldbody><body><freejoint/><geom type="ellipsoid" size="1 1 1"/></body>
      <body><freejoint/><geom type="ellipsoid" size="1 1 1"/></body></worldbody></mujoco>"""
    for tolerance in (1e-6, 1e-12):
        model = mujoco.MjModel.from_xml_string(xml)
        model.opt.ccd_tolerance = tolerance
        model.opt.ccd_iterations = 1000
        data = mujoco.MjData(model)
        times, gaps, normals, unanswered = [], [], [], 0
        ends = numpy.zeros(6)
        for bodies, gap, normal, reach in cases:
            for i, (axes, p, q) in enumerate(bodies):
                model.geom_size[i] = axes
                model.geom_rbound[i] = max(axes)
                model.geom_aabb[i] = [0, 0, 0, *axes]
                data.qpos[7 * i:7 * i + 3] = p
                data.qpos[7 * i + 3:7 * i + 7] = q
            mujoco.mj_kinematics(model, data)
            start = time.perf_counter()
            distance = mujoco.mj_geomDistance(model, data, 0, 1, 100, ends)
            times.append(time.perf_counter() - start)
            gaps.append(abs(distance - gap) / reach)
            d = ends[:3] - ends[3:]
            length = numpy.linalg.norm(d)
            if length > 0:
                normals.append(numpy.linalg.norm(d / length - normal))
            else:
                unanswered += 1
        report("mujoco", tolerance, times, gaps, normals, unanswered, len(cases))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    CASES = read_cases(sys.argv[1])
    print(HEADER)
    run_coal(CASES)
    run_mujoco(CASES)

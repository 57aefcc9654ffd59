-- SPDX-License-Identifier: MIT
--- The parts of the page that `./run report` makes (bench/page.lua): the program, which columns name its rows, its time and error
--- columns for the picture, what it says in a sentence. `curve`: which of the naming columns says whose point it is. Where time is not
--- against an error but against a size, `error` is the column of times and `time` that of the size, named in `axes`.
return {
  { name = "rotations", program = "bench_quat", names = 3, curve = 3, time = "ns", error = "error_u", title = "Rotations and interpolation",
    says = "Products, rotations, slerp and conversions beside Eigen, GLM and cglm: ns a call against the error in units of roundoff." },
  { name = "geometry", program = "bench_geometry", names = 2, curve = 1, time = "ns", error = "error",
    title = "Curves, surfaces, projections, Gauss and Bonnet",
    says = "Frames, projections, splines, integrated turning and total curvature: ns an item against the error." },
  { name = "gap", program = "bench_gap", names = 4, curve = 3, time = "time_us", error = "gap_p99", title = "Gaps",
    says = "Distance, normal and witness points beside libccd and FCL at their tolerances: the root of the tolerance is all a normal of theirs keeps." },
  { name = "impact", program = "bench_collide", names = 3, curve = 2, time = "us_median", error = "error_median", title = "One impact",
    says = "Closed form and series against CVODE through compression and restitution at its tolerances." },
  { name = "flight", program = "bench_flight", names = 3, curve = 1, time = "us", error = "error_p50", title = "Tumbling flight",
    says = "Elliptic functions against CVODE and GSL's Runge-Kutta methods: the closed form's time does not grow with the angle." },
  { name = "engines", program = "bench_engines", names = 3, curve = 2, time = "us", error = "error", title = "Scenes beside engines",
    says = "Impacts, bounces and tumbling beside ODE and Bullet at their steps: they solve another law of impact, so that smaller steps do not help.",
    slow = true },
  { name = "cones", program = "bench_cones", names = 2, time = "contacts", error = "cold_us", axes = { "contacts", "µs without a start" }, title = "Contacts held at once",
    says = "Coulomb's problem of many contacts: iterations and residuals.", slow = true },
  { name = "together", program = "bench_together", names = 4, curve = 3, time = "us", error = "error", title = "Encounters of many bodies",
    says = "Impacts at one instant by each law beside Bullet.", slow = true },
  { name = "crowd", program = "bench_crowd", names = 3, curve = 2, time = "balls", error = "us_per_event", axes = { "balls", "µs an event" }, title = "Crowds", says = "Time a body against the number of bodies, beside ODE and Bullet.",
    slow = true },
  { name = "extreme", program = "report_extreme", names = 2, curve = 1, time = "ms", error = "error", title = "Stiff and extreme cases",
    says = "How the library holds at the ends of its ranges: error or residual of each row, with its steps." , slow = true },
}

"""What the numbers are compared with: constants of an earlier independent integration, and published or closed-form values."""


def known(value, tolerance, what):
    return {"value": value, "relative_tolerance": tolerance, "what": what}


def flights(incident, reflected):
    what = "an earlier independent integration"
    return {"tof_incident_s": known(incident * 1e-6, 1e-9, what), "tof_reflected_s": known(reflected * 1e-6, 1e-9, what)}


RIG = {"rig/hertz_1": flights(630.841591, 632.265715), "rig/hertz_viscoelastic_0.5": flights(751.270959, 783.036376),
       "rig/dry_0.075": flights(1086.942704, 1120.470790), "rig/dry_1.23": flights(660.261248, 699.493431)}
EARLIER = {(case, quantity): value for case, values in RIG.items() for quantity, value in values.items()}
EARLIER |= {("equal-striker", quantity): known(value, tolerance, "an earlier independent integration") for quantity, value, tolerance in (
    ("v_max_over_v0", 0.68163155, 1e-8), ("speed_beads_per_time", 0.84050877, 1e-8), ("peak_contact_force", 0.63955423, 1e-8),
    ("speed_over_force_to_one_sixth", 0.90551577641912, 1e-9), ("speed_over_v_max_to_one_fifth", 0.90747007841219, 1e-9))}

PUBLISHED = {
    ("dimer-mass-ratio-0.3428", "loss_40_to_100"): known(0.0, 1e-4, "absolute: solitary wave at this mass ratio [Jayaprakash2011]"),
    ("dimer-mass-ratio-0.1548", "loss_40_to_100"): known(0.0, 1e-4, "absolute: solitary wave at this mass ratio [Jayaprakash2011]"),
    ("newtons-cradle/5", "ball_1_velocity"): known(-0.07, 2e-2, "rebound of a Hertz striker, from an earlier independent integration"),
    ("tapered", "last_bead_m_s"): known(4.391450573666292, 0.1, "independent hard-sphere collisions [Wu2002], an upper estimate"),
    ("light-intruder", "intruder_frequency_first_to_second_maximum_hz"): known(
        35486.84619110215, 0.1, "intruder between two contacts squeezed by the peak force, quasi-static [Job2009]"),
    ("precompressed/shot", "speed_beads_20_to_40_per_s"): known(95805.04672164239, 0.02, "long-wave solitary wave [Nesterenko1983, Coste1997]"),
    ("linear-chain", "largest_deviation_from_bessel"): known(0.0, 1e-9, "absolute: exact solution by Bessel functions"),
    ("restitution/damping_tsuji", "restitution_at_0.5_m_s"): known(0.8688046287969188, 1e-9, "closed form [Antypov2011]"),
    ("restitution/damping_viscoelastic", "restitution_at_0.5_m_s"): known(0.9581575177461522, 5e-5, "series to x^2, from an earlier independent integration"),
    ("hertz_contact_time", "constant"): known(3.21806545971904, 1e-13, "an earlier independent integration; closed form by gamma functions"),
    ("restitution/elastic_plastic_thornton", "restitution_at_0.5_m_s"): known(0.963978304195226, 1e-12, "closed form [Thornton1997]"),
}
for bead in (10, 20, 40):
    PUBLISHED[("precompressed/small", f"bead_{bead}_peak_time_s")] = known(
        {10: 0.00011356616421454314, 20: 0.00022557910596204787, 40: 0.0004468098565176429}[bead], 5e-6,
        "exact linear row, Bessel functions; the difference is the nonlinearity at 1e-5 m/s")

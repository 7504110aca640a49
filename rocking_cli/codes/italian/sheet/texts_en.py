"""The English texts of the calculation sheet by the Italian code."""

from __future__ import annotations

TEXTS = {
    "subtitle": "Verification of a local collapse mechanism, {structure}, by NTC 2018 and Circolare 7/2019.",
    "reading_digits": (
        "Numbers are printed to {digits} significant digits; the calculation uses all digits. A result recomputed from "
        "printed numbers agrees to about one unit of the fifth digit. Lengths are in m, forces in {force}, "
        "accelerations in m/s² or in g = 9.80665 m/s², angles in rad. Virtual displacements are per unit rotation of "
        "the mechanism. A symbol has the value last computed for it above; a symbol of the ground has the value of the "
        "limit state in the heading."
    ),
    "reading_marks": (
        "Formulas of the code are cited as [3.2.2] and sections as §8.3; those that begin with C are of Circolare "
        "7/2019, the others of NTC 2018. * marks a formula that was checked against a transcription of the code, but "
        "not yet against its printed text; † one that has not yet been checked: check both there before you rely on "
        "the verdict. ‡ marks our reading, or our choice where the code is silent. Unmarked lines are mechanics or "
        "arithmetic."
    ),
    # summary
    "summary": "Summary",
    "verdict": "Verdict",
    "short_SLD": "onset of rocking",
    "short_damage": "onset of rocking",
    "short_linear": "linear method",
    "short_nonlinear": "nonlinear method",
    "short_histories": "time histories",
    "verdict_passes": "{where}, {state}: the verification is satisfied. ζ_[E] = {zeta:.4g}; {why}",
    "verdict_fails": "{where}, {state}: the verification is not satisfied. ζ_[E] = {zeta:.4g}; {why}",
    "no_state": "{where}: the site does not give {state}.",
    "why_damage": (
        "the damage method governs: the structure does not start to rock below a_[g] = {a_g:.4g} g, while its "
        "capacity by displacement alone is {other:.4g} g. The demand is {asked:.4g} g."
    ),
    "why_nonlinear": (
        "the nonlinear method governs: the displacement capacity, {d:.4g} m, is {ratio:.4g} times the demand of "
        "{demand:.4g} m at T = {T:.4g} s. The capacity is a_[g] = {a_g:.4g} g, the demand {asked:.4g} g."
    ),
    "which": (
        "The {least} direction governs: the ratio of capacity to demand is {ratio:.4g}, against "
        "{rest:.4g} in the other direction."
    ),
    "both": "Both directions",
    "positive": "Positive direction (clockwise)",
    "negative": "Negative direction (anticlockwise)",
    "short_positive": "positive",
    "short_negative": "negative",
    "states": "{where}: limit states, on the exact capacity curve",
    "limit_state": "limit state",
    "allowed": "capacity",
    "asked": "demand",
    "ratio": "ratio",
    "outcome": "verification",
    "yes": "satisfied",
    "no": "not satisfied",
    "unknown": "not required",
    "begins": "{state}, onset of rocking",
    "methods": "{where}: capacity by each method",
    "method": "method",
    "exact": "exact curve",
    "line": "straight line",
    "governs": "decides {state}",
    "TR_years": "T_[R] [years]",
    "remarks": "Remarks",
    "caution": "Caution: {text}",
    # site
    "site": "Site",
    "given": "Data of the site file",
    "given_FC": "confidence factor",
    "given_q": "behaviour factor of the linear method",
    "given_ag": "ground acceleration on rock, {state}",
    "given_ordinate": "ground acceleration, the ordinate of the table at T = 0, {state}",
    "given_F0": "amplification of the spectrum, {state}",
    "given_TC": "end of the constant-acceleration branch, {state}",
    "given_S": "soil and topography factor, {state}",
    "given_VN": "nominal life",
    "given_CU": "coefficient of use",
    "given_T0": "period of the element, which vibrates freely before it rocks",
    "given_soil": "soil class",
    "given_topography": "topographic class",
    "given_z": "height of the floor above the foundation",
    "given_H": "height of the building",
    "given_T1": "first period of the building, {state}",
    "given_xi1": "damping of the building, a ratio, {state}",
    "given_n": "number of storeys",
    "ground_at": "Ground at {state}",
    "free": (
        "The element vibrates freely before it rocks: its demand is the spectral ordinate at its own period and 5 % "
        "damping."
    ),
    "VR": "reference life",
    "TR": "return period of {state}, with a {percent:g} % probability of exceedance in the reference life",
    "r": "position of T_[R] between the two rows of the table on either side, on logarithms",
    "rock_ag": "ground acceleration on rock",
    "rock_F0": "amplification of the spectrum",
    "rock_TC": "period T_[C]^[*] on rock",
    "S_S": "soil amplification factor, soil class {soil}",
    "S": "soil and topography factor",
    "C_C": "period coefficient, soil class {soil}",
    "TC": "end of the constant-acceleration branch of the spectrum",
    "TB": "start of the constant-acceleration branch of the spectrum, {state}",
    "TD": "start of the constant-displacement branch of the spectrum, {state}",
    "peak": "peak acceleration of the ground",
    "peak_of_table": "peak acceleration of the ground, the ordinate at T = 0",
    "psi": "shape of the first mode at the height of the floor",
    "gamma": "participation factor of the first mode",
    "S_Z": "peak acceleration of the floor",
    "eta": "correction for damping, ξ in per cent",
    "eta_T": "correction for damping, phased in from T = 0",
    "S_e": "ordinate of the elastic response spectrum",
    "S_5": "ordinate of the table at 5 %",
    "A": "amplification by the floor, ξ_[1] as a ratio",
    "S_eZ": "ordinate of the spectrum of the floor",
    "S_eZ_bound": "above T_[1] not below the spectrum of the ground",
    "S_De": "displacement demand",
    "S_De_long": "displacement demand, between T_[E] and T_[F]",
    "S_De_ground": "displacement demand, equal to the ground displacement",
    "S_De_floor": "displacement demand at the height of the floor",
    "d_Z": "displacement of the floor spectrum alone",
    "d_b": "bound above b T_[1]: the displacement there",
    "t": "period of the largest displacement up to T",
    # chain
    "chain": "Kinematic chain, at rest",
    "weights": (
        "Moving weights, M from the structure file: P = w M g is carried, P + Q = h M g is moved sideways, g = {g} m/s²"
    ),
    "weight": "weight",
    "block": "block",
    "of_block_P": "weight carried by the block {block}",
    "of_block_PQ": "weight P + Q moved sideways with the block {block}",
    "G": "barycentre of P + Q of the block {block}",
    "GP": "barycentre of P of the block {block}",
    "at_work_rest": (
        "Virtual displacements at rest. The block turns by θ′ about O: x′ = θ′ (y_[G] − y_[O]) in the direction of "
        "rocking, y′ = θ′ {across}"
    ),
    "at_work": (
        "Blocks at φ = {phi} rad, by the exact kinematics. Δx is the displacement of the barycentre of P + Q; "
        "x′ = θ′ (y_[G] − y_[O]), y′ = θ′ {across}"
    ),
    "action": "force or tie",
    "held": "Work of forces F and of ties N at the virtual displacements, r′ along the force and L′ the elongation",
    "tie": "tie",
    "ties_at": (
        "Ties at {state}: force and elongation; of a force against the motion, how far its point has moved against it"
    ),
    "Py": "work of the weights carried",
    "L": "work of forces and ties",
    "V_m": "work added by the mechanism itself, such as by loads among its fields: taken as given",
    "B_m": "inertia added by the mechanism itself: taken as given",
    "PQx": "first sum of the inertia",
    "PQxx": "second sum of the inertia",
    "PQ": "weight that moves sideways",
    "alpha": "multiplier",
    "e": "participating mass ratio",
    "M": "participating mass",
    "clause not in the code": "not in this edition",
    # curve
    "curve": "Capacity curve",
    "a0": "acceleration that activates the mechanism",
    "control_barycentre": "virtual displacement of the control point, the barycentre of P + Q",
    "control_point": "virtual displacement of the control point ({x}; {y}) m of {body}",
    "phi_0": "rotation at which the multiplier vanishes, checked below",
    "phi": "rotation at which the displacement is reached, checked below",
    "d_C": "displacement of the control point",
    "d0": "displacement at which the capacity vanishes",
    "d_again": "displacement at that rotation, equal to that of {state}",
    "a_there": "acceleration of the capacity curve at that displacement",
    "state": "{state}, on the exact capacity curve",
    "state_line": "{state}, on the straight line",
    "line_is": "lin: on the straight line from a_[0]^[*] at rest to d_[0]^[*], which the code also allows.",
    "d_state": "displacement capacity at {state}",
    "a_line": "acceleration of the straight line at that displacement",
    "a_elastic": "not above the elastic branch of T_[0]",
    "T": "period at {state}",
    "passes": "displacement capacity over demand at {state}: satisfied, at least 1",
    "passes_still": ("displacement capacity over demand at {state}: below 1, but satisfied, as rocking does not start"),
    "fails": "displacement capacity over demand at {state}: not satisfied, below 1",
    # methods
    "method_damage": "Damage: onset of rocking",
    "method_damage_at": "Damage: onset of rocking, at {state}",
    "method_linear": "Linear method: behaviour factor q",
    "method_nonlinear_at": "Nonlinear method, displacement at {state}",
    "method_SLD": "Damage, checked at SLD",
    "and_line": "on the straight line",
    "linear_at": "Linear method: q times the onset of rocking, by the ground of {state}",
    "mode_of_SLD": "T_[1] and ξ_[1] are here those of SLD.",
    "a_g_start": "ground acceleration on rock at which rocking starts, by the ground of {state}",
    "a_g_method": "capacity as a ground acceleration on rock",
    "a_g_start_iterated": (
        "ground acceleration on rock at which rocking starts, by the ground of {state}, found by iteration"
    ),
    "a_g_method_iterated": "capacity as a ground acceleration on rock, found by iteration",
    "check": "Check, with the ground of {state} at this a_[g]: F_[0], T_[C] and S unchanged, T_[D] recomputed.",
    "zeta": "capacity over demand at {state}",
    "TR_capacity": "capacity as a return period, found by iteration",
    "check_TR": "Check, with the ground of this return period:",
    "beyond_long": "Return period: more than {TR} years, the end of the table.",
    "beyond_short": "Return period: less than {TR} years, the beginning of the table.",
    # dynamic
    "dynamic": "Dynamic method",
    "dynamic_is": (
        "Time histories on the capacity curve with restitution (§C8.7.1.2.1.9): the verification is satisfied if no "
        "record takes the structure past d_[0]^[*] = {d0:.6g} m and the mean peak displacement is within the "
        "displacement capacity of {state}, to which the records belong; they verify no other limit state."
    ),
    "as_given": "The motions act on the structure as given.",
    "carried_to_floor": (
        "The ground motions are carried to the floor by the first mode of the building: {floor}, z over the height of "
        "the building."
    ),
    "carried_by_option": "The ground motions are carried to the floor given with the records: {floor}.",
    "of_floor": "The motions are taken as motions of the floor, as stated, and not of the ground.",
    "dynamic_table": "Peak displacement d [m]",
    "record": "record",
    "with_FC": "with FC",
    "without_FC": "without FC",
    "overturns": "overturns",
    "past": "past d_[0]^[*]",
    "holds": "{which}, {state}: satisfied. The mean peak displacement, {mean:.6g} m, is within {allowed:.6g} m.",
    "holds_not": "{which}, {state}: not satisfied. The mean peak displacement, {mean:.6g} m, exceeds {allowed:.6g} m.",
    "past_d0": "{which}: not satisfied. d_[0]^[*] is exceeded under {names}.",
    "unknown_after": "unknown after {time} s",
    "unknown_fails": (
        "{which}, {state}: not satisfied. The outcome under {names} is unknown, as a joint opens or slides that the "
        "model keeps closed: an unknown outcome does not pass."
    ),
    "not_checked": (
        "Caution: the joints of this mechanism are not checked: it does not say which of them stay closed."
    ),
    "few": "Only {count} records were used: the code requires at least {enough} before the mean may be used.",
    "one": "Only one record was used: the code requires at least {enough} before the mean may be used.",
}

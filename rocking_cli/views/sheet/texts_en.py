"""What a sheet says in English."""

from __future__ import annotations

MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November",
    "December",
)  # fmt: skip
MECHANISMS: dict[str, str] = {}
CAUTIONS: dict[str, str] = {}
PICTURES: dict[str, str] = {}
TEXTS = {
    # head
    "lang": "en",
    "title": "Calculation sheet: {name}",
    "subtitle": "Verification of a local mechanism of collapse, {structure}, by NTC 2018 and Circolare 7/2019.",
    "project": "Project",
    "place": "Place",
    "author": "Author",
    "date": "Date",
    "site_name": "Site",
    "program": "Program",
    "logo": "Logo",
    "sections": "Sections",
    "skip": "Skip to the summary",
    "swipe": "On a narrow screen, swipe tables and the picture sideways to see all of them.",
    "quantity": "quantity",
    "symbol": "symbol",
    "value": "value",
    "unit": "unit",
    "years": "years",
    # how to read it
    "reading": "How to read it",
    "reading_digits": (
        "Every number is printed to {digits} significant digits, and computed on with all of its digits: recomputed "
        "from printed numbers, a result agrees to one unit or so of the fifth digit. Lengths are in m, forces in "
        "{force}, accelerations in m/s² or in g = 9.80665 m/s², angles in rad. A virtual displacement is per unit "
        "rotation of the mechanism. A symbol has the value that was last computed for it above, one of the ground that "
        "of the limit state in the heading."
    ),
    "reading_marks": (
        "† is a formula of the code that was not yet held against its printed text: check it there before you rely on "
        "the verdict. ‡ is our reading, or our choice where the code leaves it open. What has no mark is mechanics or "
        "arithmetic. Clauses that begin with C are those of Circolare 7/2019, the others those of NTC 2018."
    ),
    "per_kilogram": "The file gives no masses: weights are per kilogram of the whole structure, in N/kg.",
    # summary
    "summary": "Summary",
    "verdict": "Verdict",
    "verdict_passes": "{where}, {state}: the verification is satisfied. ζ_[E] = {zeta:.4g}; {why}",
    "verdict_fails": "{where}, {state}: the verification is not satisfied. ζ_[E] = {zeta:.4g}; {why}",
    "no_state": "{where}: the site does not give {state}.",
    "why_damage": (
        "damage governs: below a_[g] = {a_g:.4g} g it does not begin to rock, and by displacement alone it could take "
        "{other:.4g} g. Asked for are {asked:.4g} g."
    ),
    "why_nonlinear": (
        "the nonlinear method governs: the displacement allowed, {d:.4g} m, is {ratio:.4g} times the {demand:.4g} m "
        "asked for at T = {T:.4g} s. It can take a_[g] = {a_g:.4g} g, asked for are {asked:.4g} g."
    ),
    "which": (
        "The {least} direction governs: displacement allowed over demand is {ratio:.4g}, in the other {rest:.4g}."
    ),
    "both": "Both directions",
    "positive": "Positive direction (clockwise)",
    "negative": "Negative direction (anticlockwise)",
    "short_positive": "positive",
    "short_negative": "negative",
    "states": "{where}: limit states, on the exact capacity curve",
    "limit_state": "limit state",
    "allowed": "allowed",
    "asked": "asked for",
    "ratio": "ratio",
    "outcome": "verification",
    "yes": "satisfied",
    "no": "not satisfied",
    "unknown": "not asked",
    "begins": "{state}, begins to rock",
    "methods": "{where}: what each method allows",
    "method": "method",
    "exact": "exact curve",
    "line": "straight line",
    "governs": "governs",
    "TR_years": "T_[R] [years]",
    "remarks": "Remarks",
    "caution": "Caution: {text}",
    # drawing
    "drawing": "Drawing",
    "drawing_label": "{name} at rest with its dimensions, and displaced to its critical rotation",
    # site
    "site": "Site",
    "given": "What the site file gives",
    "given_FC": "confidence factor",
    "given_q": "behaviour factor of the linear method",
    "given_ag": "ground acceleration on rock, {state}",
    "given_ordinate": "ground acceleration, the ordinate of the table at T = 0, {state}",
    "given_F0": "amplification of the spectrum, {state}",
    "given_TC": "end of its level part, {state}",
    "given_S": "factor of soil and topography, {state}",
    "given_VN": "nominal life",
    "given_CU": "coefficient of use",
    "given_T0": "period of the element, which vibrates freely before it rocks",
    "given_soil": "category of the soil",
    "given_topography": "category of the topography",
    "given_z": "height of the floor above the foundation",
    "given_H": "height of the building",
    "given_T1": "first period of the building",
    "given_xi1": "damping of the building, a ratio",
    "given_n": "number of storeys",
    "ground_at": "Ground at {state}",
    "free": "The element vibrates freely before it rocks: what starts it is the spectrum at its own period, at 5 %.",
    "VR": "reference life",
    "TR": "return period of {state}, of {percent:g} % in the reference life",
    "r": "share between the rows of the table on either side of T_[R], on logarithms",
    "rock_ag": "ground acceleration on rock",
    "rock_F0": "amplification of the spectrum",
    "rock_TC": "period T_[C]^[*] on rock",
    "S_S": "factor of soil {soil}",
    "S": "factor of soil and topography",
    "C_C": "factor of soil {soil} on the period",
    "TC": "end of the level part of the spectrum",
    "TB": "corner period of the spectrum, {state}",
    "TD": "corner period of the spectrum, {state}",
    "peak": "peak acceleration of the ground",
    "peak_of_table": "peak acceleration of the ground, the ordinate at T = 0",
    "psi": "shape of the first mode at the height of the floor",
    "gamma": "participation of the first mode",
    "S_Z": "peak acceleration of the floor",
    "eta": "correction for damping, ξ in per cent",
    "eta_T": "the correction grows in from T = 0",
    "S_e": "ordinate of the elastic response spectrum",
    "S_5": "ordinate of the table at 5 %",
    "A": "amplification by the floor, ξ_[1] as a ratio",
    "S_eZ": "ordinate of the spectrum of the floor",
    "S_eZ_bound": "above T_[1] not below the spectrum of the ground",
    "S_De": "displacement asked for",
    "S_De_long": "displacement asked for, between T_[E] and T_[F]",
    "S_De_ground": "displacement asked for, that of the ground",
    "S_De_floor": "displacement asked for at the height of the floor",
    "d_Z": "displacement of the floor spectrum alone",
    "d_b": "bound above b T_[1]: the displacement there",
    "t": "period of the largest displacement up to T",
    # chain
    "chain": "Kinematic chain, at rest",
    "weights": (
        "Weights that move, M from the structure file: P = w M g is carried, P + Q = h M g is moved sideways, "
        "g = {g} m/s²"
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
        "Blocks at φ = {phi} rad, by the exact kinematics. Δx is how far the barycentre of P + Q has gone; "
        "x′ = θ′ (y_[G] − y_[O]), y′ = θ′ {across}"
    ),
    "action": "force or tie",
    "held": "Work of forces F and of ties N at the virtual displacements, r′ along the force and L′ the elongation",
    "Py": "work of the weights carried",
    "L": "work of forces and ties",
    "V_m": "what the mechanism itself adds to the work, such as loads among its fields: taken as given",
    "B_m": "what the mechanism itself adds to the inertia: taken as given",
    "PQx": "first sum of the inertia",
    "PQxx": "second sum of the inertia",
    "PQ": "weight that moves sideways",
    "alpha": "multiplier",
    "e": "share of the mass that takes part",
    "M": "mass that takes part",
    "not_in_edition": "not in this edition",
    # curve
    "curve": "Capacity curve",
    "a0": "acceleration that starts it",
    "control_barycentre": "virtual displacement of the control point, the barycentre of P + Q",
    "control_point": "virtual displacement of the control point ({x}; {y}) m of {body}",
    "phi_0": "rotation at which the multiplier vanishes; it is checked below",
    "phi": "rotation at which the displacement is reached; it is checked below",
    "d_C": "displacement of the control point",
    "d0": "displacement at which the capacity vanishes",
    "d_again": "displacement there: it is that of {state}",
    "a_there": "acceleration of the capacity curve there",
    "state": "{state}, on the exact capacity curve",
    "state_line": "{state}, on the straight line",
    "line_is": "lin: on the straight line from a_[0]^[*] at rest to d_[0]^[*], which the code allows too.",
    "d_state": "displacement allowed at {state}",
    "a_line": "acceleration of the straight line there",
    "a_elastic": "not above the elastic branch of T_[0]",
    "T": "period at {state}",
    "passes": "displacement allowed over demand at {state}: satisfied, at least 1",
    "fails": "displacement allowed over demand at {state}: not satisfied, below 1",
    # methods
    "method_damage": "Damage: it begins to rock",
    "method_linear": "Linear method: behaviour factor q",
    "method_nonlinear": "Nonlinear method, displacement at SLV",
    "method_nonlinear_SLC": "Nonlinear method, displacement at SLC",
    "method_SLD": "Damage, held against SLD",
    "and_line": "on the straight line",
    "qa0": "capacity of the linear method",
    "a_g_method": "ground acceleration on rock that it can take",
    "a_g_solved": "ground acceleration on rock that it can take, by trial",
    "check": "Check, by the ground of {state} with this a_[g]: F_[0], T_[C] and S held, T_[D] following.",
    "zeta": "capacity over what is asked for at {state}",
    "TR_capacity": "return period that it can take, by trial",
    "check_TR": "Check, by the ground of this return period:",
    "beyond_long": "Return period: more than {TR} years, the end of the table.",
    "beyond_short": "Return period: less than {TR} years, the beginning of the table.",
    # dynamic
    "dynamic": "Dynamic method",
    "dynamic_is": (
        "Histories on the capacity curve with restitution [C8.7.1.2.1.9]: it holds if no record passes d_[0]^[*] = "
        "{d0:.6g} m and the mean of the largest displacements is within that of the limit state."
    ),
    "dynamic_table": "Largest displacement d [m]",
    "record": "record",
    "with_FC": "with FC",
    "without_FC": "without FC",
    "overturns": "overturns",
    "past": "past d_[0]^[*]",
    "mean_of": "mean of the largest displacements, {which}",
    "holds": "{which}, {state}: the mean of {mean:.6g} m is within {allowed:.6g} m: satisfied.",
    "holds_not": "{which}, {state}: the mean of {mean:.6g} m is beyond {allowed:.6g} m: not satisfied.",
    "past_d0": "{which}: not satisfied, past d_[0]^[*] go {names}.",
    "few": "These are {count} records: the code wants {enough} or more for a mean.",
    "one": "This is one record: the code wants {enough} or more for a mean.",
    # inputs
    "inputs": "Files and versions",
    "inputs_are": "With these files and versions this command writes the sheet again.",
    "files": "Files",
    "file": "file",
    "structure_file": "structure",
    "site_file": "site",
    "record_file": "record",
    "pulse": "pulse, made from its formula",
    "versions": "Versions",
    "package": "package",
    "version": "version",
    "structure_text": "Structure file",
    "site_text": "Site file",
    "cut": "(the file goes on: {more} lines are not printed)",
    "source": "Mechanism: {source}.",
}

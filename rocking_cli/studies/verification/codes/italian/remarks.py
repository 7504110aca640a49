"""The sentences of `wordings`, in each language."""

from __future__ import annotations

ENGLISH = {
    "and": "{one} and {other}",
    "long": "A period of {T:.3g} s is above {most:g} s, where the code asks for a study of the site or for records.",
    "missing": "The site file does not give {states}: nothing is held against it.",
    "confidence": (
        "FC = {FC:g}: it is {least:g}, that of LC1, as long as no compressive strength is taken into account."
    ),
    "seats": (
        "The code ends d_SLC also where parts lose their seat, such as beams: a load may say its `seat`, and one here "
        "does not."
    ),
    "seat": "The load {name} is moved off its seat of {length:.3g} m at d = {d:.4g} m: d_SLC ends there.",
    "no_soil": (
        "No soil is given: displacements at long periods do not go down to those of the ground, which is on the "
        "safe side."
    ),
    "floor": (
        "The floor amplifies by A = 1.1 xi1^-1/2 eta(xi) with xi1 as a ratio: our reading; in per cent, as the "
        "code prints, A would reduce."
    ),
    "low_floor": (
        "The peak of the floor, S_Z = {floor:.4g} g, is below that of the ground, a_g S = {ground:.4g} g: one mode "
        "says too little so far down."
    ),
    "bound": "The return period of {state}, {TR:.4g} years, is taken as {bound:g} years.",
    "elastic": "d_{states} lie on the elastic branch of T0 = {T0:g} s.",
    "above": "above",
    "below": "below",
    "more": "more",
    "less": "less",
    "line": (
        "The straight line leaves the exact curve by up to {most:.2g} % of a0*; at d_SLV it is {there:.2g} % {side} "
        "it. The exact curve counts."
    ),
    "ties": (
        "A tie is in alpha0 by its force at rest: the rigid-plastic tie of the code is one with its yield force as "
        "prestress, or a force. What is elastic here brings a* to {largest:.4g} m/s2 at most, {over:.3g} times a0*."
    ),
    "at_rest": (
        "Held by what is elastic ({names}) a* would vanish nowhere, and the code counts what is there up to collapse: "
        "it is taken as it pulls at rest, here and in histories. To count on more, give the "
        "yield force as a load or as a prestress without stiffness."
    ),
    "carries": "At d_SLV the tie {name} carries {force:.4g} kN: it and its anchors must hold that.",
    "torn": (
        "The courses of the crossing walls have slid apart at d = {d:.4g} m: d0* is that of the curve without them, "
        "which alone is there up to collapse."
    ),
    "ends": "That takes more than half of the largest a*, so that d_SLV ends there.",
    "own_formula": (
        "alpha0 = {alpha0:.6g} is not lambda = {lambda_:.6g}: the mechanism has its own formula of the latter."
    ),
    "letter": (
        "What is carried without horizontal inertia is in P y' only, our choice; by the letter every P is in P + Q: "
        "alpha0 would be {by_letter:.4g} (here {alpha0:.4g}) and a0* {a_letter:.4g} m/s2 (here {a0:.4g})."
    ),
    "control_same": "With this control point d0* is that of the barycentre of P + Q, {d0:.4g} m.",
    "control": (
        "With this control point d0* is {d0:.4g} m, {change:.3g} % {side} than {own:.4g} m by the barycentre of P + Q."
    ),
    "control_a_g": (
        "With this control point d0* is {d0:.4g} m, {change:.3g} % {side} than {own:.4g} m by the barycentre of P + Q; "
        "the nonlinear method allows {a_g:.4g} g, by the barycentre {usual:.4g} g."
    ),
}
ITALIAN = {
    "and": "{one} e {other}",
    "long": (
        "Un periodo di {T:.3g} s supera {most:g} s, oltre i quali la norma chiede uno studio del sito o accelerogrammi."
    ),
    "missing": "Il file del sito non assegna {states}: per tali stati limite non si esegue alcuna verifica.",
    "confidence": "FC = {FC:g}: vale {least:g}, quello di LC1, finché non si considera la resistenza a compressione.",
    "seats": (
        "La norma limita d_SLC anche per la perdita dell'appoggio di elementi quali le travi: di un carico si può "
        "assegnare l'appoggio (`seat`), e qui di qualcuno manca."
    ),
    "seat": "Il carico {name} perde il suo appoggio di {length:.3g} m a d = {d:.4g} m: d_SLC termina in quel punto.",
    "no_soil": (
        "La categoria di sottosuolo non è assegnata: ai lunghi periodi gli spostamenti non si riducono a quelli del "
        "terreno, a favore di sicurezza."
    ),
    "floor": (
        "Il piano amplifica con A = 1,1 xi1^-1/2 eta(xi), con xi1 come rapporto: è la nostra lettura; in percentuale, "
        "come stampato, A sarebbe una riduzione."
    ),
    "low_floor": (
        "Il picco alla quota, S_Z = {floor:.4g} g, è minore di quello del terreno, a_g S = {ground:.4g} g: un solo "
        "modo non basta a descrivere quote così basse."
    ),
    "bound": "Per {state} il periodo di ritorno di {TR:.4g} anni è posto pari a {bound:g} anni.",
    "elastic": "d_{states}: il punto sta sul ramo elastico di T0 = {T0:g} s.",
    "above": "sopra",
    "below": "sotto",
    "more": "in più",
    "less": "in meno",
    "line": (
        "La retta si scosta dalla curva di capacità esatta fino al {most:.2g} % di a0*; in d_SLV sta {there:.2g} % "
        "{side}. Vale la curva esatta."
    ),
    "ties": (
        "Il tirante entra in alpha0 con la sua forza a riposo: il tirante rigido-plastico della norma si assegna con "
        "la forza di snervamento come pretensione, o come forza. Ciò che qui è elastico porta a* al massimo a "
        "{largest:.4g} m/s2, {over:.3g} volte a0*."
    ),
    "at_rest": (
        "Con ciò che è elastico ({names}) a* non si annullerebbe mai, e la norma considera quanto è presente fino al "
        "collasso: qui e nelle analisi al passo esso agisce con la forza a riposo. Per contare "
        "su di più si assegni la forza di snervamento come carico, o come pretensione senza rigidezza."
    ),
    "carries": "In d_SLV il tirante {name} porta {force:.4g} kN: il tirante e i suoi ancoraggi devono reggerli.",
    "torn": (
        "I filari delle pareti ortogonali si sfilano a d = {d:.4g} m: d0* è quello della curva senza di essi, la sola "
        "presente fino al collasso."
    ),
    "ends": "Si perde così più della metà del massimo di a*: d_SLV termina in quel punto.",
    "own_formula": (
        "alpha0 = {alpha0:.6g} non coincide con lambda = {lambda_:.6g}: per quest'ultimo il meccanismo ha una formula "
        "propria."
    ),
    "letter": (
        "Il peso portato privo di inerzia orizzontale entra soltanto in P y', per nostra scelta; alla lettera ogni P "
        "è in P + Q: alpha0 sarebbe {by_letter:.4g} (qui {alpha0:.4g}) e a0* {a_letter:.4g} m/s2 (qui {a0:.4g})."
    ),
    "control_same": "Con questo punto di controllo d0* coincide con quello del baricentro di P + Q, {d0:.4g} m.",
    "control": (
        "Con questo punto di controllo d0* vale {d0:.4g} m, il {change:.3g} % {side} rispetto a {own:.4g} m del "
        "baricentro di P + Q."
    ),
    "control_a_g": (
        "Con questo punto di controllo d0* vale {d0:.4g} m, il {change:.3g} % {side} rispetto a {own:.4g} m del "
        "baricentro di P + Q; il metodo non lineare ammette {a_g:.4g} g, con il baricentro {usual:.4g} g."
    ),
}
TEXTS = {"en": ENGLISH, "it": ITALIAN}

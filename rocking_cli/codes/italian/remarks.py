"""The sentences of `wordings`, in each language."""

from __future__ import annotations

ENGLISH = {
    "and": "{one} and {other}",
    "long": (
        "The longest period, {T:.3g} s, exceeds {most:g} s, above which the code requires a site-specific study or "
        "records."
    ),
    "missing": "The site file does not give {states}: no verification is made for what is missing.",
    "confidence": (
        "FC = {FC:g}: the value must be {least:g}, that of LC1, as long as no compressive strength is taken into "
        "account."
    ),
    "seats": (
        "The code also limits {limited} by the loss of support of parts such as beams. This is not checked for "
        "loads without a `seat` (length of support), and at least one load has none: give it."
    ),
    "seat": "The load {name} loses its seat of {length:.3g} m at d = {d:.4g} m, which limits {limited}.",
    "no_soil": (
        "No soil class is given: at long periods, displacements are not reduced to the ground displacement, which is "
        "conservative."
    ),
    "floor": (
        "The floor amplification A = 1.1 xi1^-1/2 eta(xi) is evaluated with xi1 as a ratio. This is our reading: with "
        "xi1 in per cent, as printed in the code, A would be a reduction."
    ),
    "one_mode": (
        "The floor spectrum is that of the first mode alone. At SLD, and in the linear method, the code combines all "
        "significant modes: the others are missing here, which may be unconservative for stiff elements and low floors."
    ),
    "same_mode": (
        "Caution: T1 = {T1:g} s and xi1 = {xi1:g} of the floor are used at all limit states. At SLV and SLC, a damaged "
        "building has a period 50 to 100 % longer than at SLD and a damping of 10 to 20 %: a single pair is "
        "unconservative at SLD and in the linear method, or at SLV and SLC. Give `SLD: {{T1, xi1}}` in `floor`, and "
        "T1 and xi1 of SLV beside it."
    ),
    "same_mode_further": "T1 = {T1:g} s and xi1 = {xi1:g} of the floor at SLV are used at {states} too.",
    "linear_SLV": (
        "The linear method multiplies by q the a_g at which rocking starts at SLD. The site file does not give SLD in "
        "the same way as SLV, so F0, TC and S of SLV are used, which is our choice."
    ),
    "low_floor": (
        "The peak acceleration of the floor, S_Z = {floor:.4g} g, is below that of the ground, a_g S = {ground:.4g} "
        "g: one mode is not sufficient so low in the building."
    ),
    "bound": "The return period of {state}, {TR:.4g} years, is taken as {bound:g} years.",
    "elastic": "d_{states} lie on the elastic branch of T0 = {T0:g} s.",
    "above": "above",
    "below": "below",
    "more": "more",
    "less": "less",
    "line": (
        "The straight line deviates from the exact curve by up to {most:.2g} % of a0*; at d_SLV it is {there:.2g} % "
        "{side} it. The exact curve is used for the verdict."
    ),
    "linear_same": "The linear method gives the same capacity at {state}, {linear:.4g} g.",
    "linear_less": (
        "The linear method gives only {linear:.4g} g, {share:.3g} % of the capacity at {state}: it accepts {times:.3g} "
        "times the acceleration at which rocking starts, and ignores that the structure may then rock, with a period "
        "of {T:.3g} s, up to its displacement capacity of {d:.3g} m."
    ),
    "linear_more": (
        "The linear method gives {linear:.4g} g, {ratio:.3g} times the capacity at {state}: it accepts {times:.3g} "
        "times the acceleration at which rocking starts, and ignores that the structure would then exceed its "
        "displacement capacity of {d:.3g} m. It is unconservative here."
    ),
    "straight": (
        "With the straight line from a0* to d0*, the nonlinear method gives a capacity of {line:.4g} g, "
        "{change:.2g} % {side} than with the exact curve."
    ),
    "ties": (
        "A tie contributes to alpha0 with its force at rest. To model the rigid-plastic tie of the code, give its "
        "yield force as a load, or as the `prestress` of a tie with `stiffness: 0`. The elastic ties here raise a* to "
        "at most {largest:.4g} m/s2, {over:.3g} times a0*."
    ),
    "at_rest": (
        "With its elastic ties ({names}), a* would never vanish, and the code counts only what acts up to collapse. "
        "The ties are therefore taken with their force at rest, here and in time histories, and their area and "
        "stiffness have no effect. To count on more, give the yield force as a load, or as the `prestress` of a tie "
        "with `stiffness: 0`."
    ),
    "carries": "At d_SLV the tie {name} carries {force:.4g} kN: check that the tie and its anchorages can resist it.",
    "stretched": (
        "Caution: at d_{state} the tie {name} is {e:.3g} m longer than at rest, {strain:.2g} % of its length. Beyond "
        "about {most:g} %, a tie or its anchorages may have failed, and the force assumed may no longer be there."
    ),
    "follows": (
        "At d_{state} the point of {name} has moved {e:.3g} m against its force. A tie that gives this force elongates "
        "by less than {most:g} % only if it is longer than {length:.3g} m."
    ),
    "wide": (
        "Caution: at d_{state} the centroid of a block moves {moved:.3g} m sideways, and the block is {thickness:.3g} "
        "m thick. A free block falls at half its thickness: the verdict relies on ties or forces that follow this far."
    ),
    "torn": (
        "The courses of the crossing walls lose their overlap at d = {d:.4g} m. d0* is therefore that of the curve "
        "without them, the only one that holds up to collapse."
    ),
    "ends": "This removes more than half of the largest a*, so d_SLV is limited to that displacement.",
    "own_formula": (
        "alpha0 = {alpha0:.6g} differs from lambda = {lambda_:.6g}: the mechanism has its own formula for lambda."
    ),
    "letter": (
        "Weights carried without horizontal inertia, such as that of a sliding floor, enter the work of the weights "
        "(P y') but not the inertia (P + Q); this is our choice. By the letter of the code they enter both: {alpha0}, "
        "and a0* {letter:.{digits}g} m/s2 instead of {own:.{digits}g} m/s2."
    ),
    "alpha0_by_letter": "alpha0 would be {letter:.{digits}g} instead of {own:.{digits}g}",
    "alpha0_same": "alpha0 would be the same",
    "control_same": "With this control point, d0* is the same as with the centroid of P + Q, {d0:.4g} m.",
    "control": (
        "With this control point, d0* is {d0:.4g} m, {change:.3g} % {side} than the {own:.4g} m obtained with the "
        "centroid of P + Q."
    ),
    "control_a_g": (
        "With this control point, d0* is {d0:.4g} m, {change:.3g} % {side} than the {own:.4g} m obtained with the "
        "centroid of P + Q; the capacity by the nonlinear method is {a_g:.4g} g, against {usual:.4g} g with the "
        "centroid."
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
        "La norma limita {limited} anche per la perdita dell'appoggio di elementi quali le travi: di un carico si "
        "può assegnare l'appoggio (`seat`), e qui di qualcuno manca."
    ),
    "seat": "Il carico {name} perde il suo appoggio di {length:.3g} m a d = {d:.4g} m, che limita {limited}.",
    "no_soil": (
        "La categoria di sottosuolo non è assegnata: ai lunghi periodi gli spostamenti non si riducono a quelli del "
        "terreno, a favore di sicurezza."
    ),
    "floor": (
        "Il piano amplifica con A = 1,1 xi1^-1/2 eta(xi), con xi1 come rapporto: è la nostra lettura; in percentuale, "
        "come stampato, A sarebbe una riduzione."
    ),
    "one_mode": (
        "Lo spettro alla quota è quello del solo primo modo. Allo SLD, e nel metodo lineare, la norma combina tutti i "
        "modi significativi: qui mancano gli altri, talvolta a sfavore di sicurezza per elementi rigidi e quote basse."
    ),
    "same_mode": (
        "Attenzione: T1 = {T1:g} s e xi1 = {xi1:g} dell'edificio valgono qui per tutti gli stati limite. Agli SLV e "
        "SLC l'edificio danneggiato ha un periodo più lungo del 50-100 % rispetto allo SLD e uno smorzamento del 10-20 "
        "%: una sola coppia è a sfavore di sicurezza allo SLD e nel metodo lineare, oppure allo SLV e allo SLC. Si "
        "assegni `SLD: {{T1, xi1}}` in `floor`, accanto ai valori dello SLV."
    ),
    "same_mode_further": "T1 = {T1:g} s e xi1 = {xi1:g} dell'edificio allo SLV valgono anche per lo {states}.",
    "linear_SLV": (
        "Il metodo lineare moltiplica per q l'accelerazione a_g di attivazione allo SLD. Il file del sito non assegna "
        "lo SLD nello stesso modo dello SLV: si usano F0, TC e S dello SLV, per nostra scelta."
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
    "linear_same": "Il metodo lineare fornisce la stessa capacità allo {state}, {linear:.4g} g.",
    "linear_less": (
        "Il metodo lineare fornisce soltanto {linear:.4g} g, il {share:.3g} % della capacità allo {state}: ammette "
        "{times:.3g} volte l'accelerazione di attivazione e trascura che la struttura può poi oscillare, con un "
        "periodo di {T:.3g} s, fino alla sua capacità di spostamento di {d:.3g} m."
    ),
    "linear_more": (
        "Il metodo lineare fornisce {linear:.4g} g, {ratio:.3g} volte la capacità allo {state}: ammette {times:.3g} "
        "volte l'accelerazione di attivazione e trascura che la struttura supererebbe la sua capacità di spostamento "
        "di {d:.3g} m. Qui è a sfavore di sicurezza."
    ),
    "straight": (
        "Con la retta da a0* a d0* il metodo non lineare fornisce una capacità di {line:.4g} g, il {change:.2g} % "
        "{side} rispetto alla curva esatta."
    ),
    "ties": (
        "Il tirante entra in alpha0 con la sua forza a riposo: il tirante rigido-plastico della norma si assegna con "
        "la forza di snervamento come carico, o come `prestress` di un tirante con `stiffness: 0`. Ciò che qui è "
        "elastico porta a* al massimo a {largest:.4g} m/s2, {over:.3g} volte a0*."
    ),
    "at_rest": (
        "Con ciò che è elastico ({names}) a* non si annullerebbe mai, e la norma considera quanto è presente fino al "
        "collasso: qui e nelle analisi al passo esso agisce con la forza a riposo, e la sua area e la sua rigidezza "
        "non hanno effetto. Per contare su di più si assegni la forza di snervamento come carico, o come `prestress` "
        "di un tirante con `stiffness: 0`."
    ),
    "carries": "In d_SLV il tirante {name} porta {force:.4g} kN: il tirante e i suoi ancoraggi devono reggerli.",
    "stretched": (
        "Attenzione: in d_{state} il tirante {name} è più lungo di {e:.3g} m che a riposo, il {strain:.2g} % della sua "
        "lunghezza. Oltre il {most:g} % circa il tirante o i suoi ancoraggi possono aver ceduto, e la forza assunta "
        "può non esserci più."
    ),
    "follows": (
        "In d_{state} il punto di {name} si è spostato di {e:.3g} m contro la sua forza. Un tirante che la fornisce si "
        "allunga meno del {most:g} % solo se è più lungo di {length:.3g} m."
    ),
    "wide": (
        "Attenzione: in d_{state} il baricentro di un blocco si sposta in orizzontale di {moved:.3g} m, e il blocco "
        "è spesso {thickness:.3g} m. Un blocco isolato cade a metà del suo spessore: l'esito conta su tiranti o forze "
        "che lo seguono fin lì."
    ),
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
        "è in P + Q: {alpha0} e a0* {letter:.{digits}g} m/s2 (qui {own:.{digits}g})."
    ),
    "alpha0_by_letter": "alpha0 sarebbe {letter:.{digits}g} (qui {own:.{digits}g})",
    "alpha0_same": "alpha0 sarebbe lo stesso",
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

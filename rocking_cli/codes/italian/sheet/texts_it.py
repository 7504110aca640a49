"""The Italian texts of the calculation sheet, in the terms of the code where it has them."""

from __future__ import annotations

TEXTS = {
    "subtitle": (
        "Verifica di un meccanismo locale di corpo rigido in muratura, {structure}, secondo le NTC 2018 e la "
        "Circolare 7/2019."
    ),
    "reading_digits": (
        "Ogni numero è stampato con {digits} cifre significative, mentre il calcolo prosegue con tutte le cifre: "
        "rifatto con i numeri stampati, un risultato coincide a meno di circa un'unità della quinta cifra. Le "
        "lunghezze sono in m, le forze in {force}, le accelerazioni in m/s² o in g = 9,80665 m/s², gli angoli in rad. "
        "Gli spostamenti virtuali sono riferiti a una rotazione unitaria del meccanismo. Ogni simbolo ha l'ultimo "
        "valore calcolato più sopra; quelli dell'azione sismica sono dello stato limite indicato nel titolo."
    ),
    "reading_marks": (
        "Le formule della norma sono citate come [3.2.2] e i punti come §8.3: quelli che iniziano con C sono della "
        "Circolare 7/2019, gli altri delle NTC 2018. * indica una formula confrontata con una trascrizione della "
        "norma, ma non ancora con il testo a stampa; † una non ancora confrontata: entrambe vanno controllate prima di "
        "fare affidamento sull'esito. ‡ indica una nostra lettura, o una nostra scelta dove la norma lascia libertà. "
        "Ciò che non ha segno è meccanica o aritmetica."
    ),
    # summary
    "summary": "Sintesi",
    "verdict": "Esito",
    "short_SLD": "attivazione del meccanismo",
    "short_damage": "attivazione del meccanismo",
    "short_linear": "metodo lineare",
    "short_nonlinear": "metodo non lineare",
    "short_histories": "analisi dinamica",
    "verdict_passes": "{where}, {state}: la verifica è soddisfatta. ζ_[E] = {zeta:.4g}; {why}",
    "verdict_fails": "{where}, {state}: la verifica non è soddisfatta. ζ_[E] = {zeta:.4g}; {why}",
    "no_state": "{where}: il sito non assegna {state}.",
    "why_damage": (
        "governa l'attivazione del meccanismo: sotto a_[g] = {a_g:.4g} g non inizia il dondolio, e in termini di soli "
        "spostamenti potrebbe sopportare {other:.4g} g. La domanda è {asked:.4g} g."
    ),
    "why_nonlinear": (
        "governa il metodo non lineare: lo spostamento ammesso, {d:.4g} m, è {ratio:.4g} volte la domanda di "
        "{demand:.4g} m a T = {T:.4g} s. La capacità è a_[g] = {a_g:.4g} g, la domanda {asked:.4g} g."
    ),
    "which": ("Governa il verso {least}: il rapporto tra capacità e domanda è {ratio:.4g}, nell'altro {rest:.4g}."),
    "both": "Entrambi i versi",
    "positive": "Verso positivo (orario)",
    "negative": "Verso negativo (antiorario)",
    "short_positive": "positivo",
    "short_negative": "negativo",
    "states": "{where}: stati limite, sulla curva di capacità esatta",
    "limit_state": "stato limite",
    "allowed": "capacità",
    "asked": "domanda",
    "ratio": "rapporto",
    "outcome": "verifica",
    "yes": "soddisfatta",
    "no": "non soddisfatta",
    "unknown": "non richiesta",
    "begins": "{state}, attivazione del meccanismo",
    "methods": "{where}: capacità secondo ciascun metodo",
    "method": "metodo",
    "exact": "curva esatta",
    "line": "retta",
    "governs": "decide {state}",
    "TR_years": "T_[R] [anni]",
    "remarks": "Osservazioni",
    "caution": "Attenzione: {text}",
    # site
    "site": "Sito",
    "given": "Dati del file del sito",
    "given_FC": "fattore di confidenza",
    "given_q": "fattore di comportamento del metodo lineare",
    "given_ag": "accelerazione al suolo su roccia, {state}",
    "given_ordinate": "accelerazione al suolo, ordinata della tabella a T = 0, {state}",
    "given_F0": "amplificazione spettrale massima, {state}",
    "given_TC": "fine del tratto ad accelerazione costante, {state}",
    "given_S": "coefficiente di sottosuolo e topografia, {state}",
    "given_VN": "vita nominale",
    "given_CU": "coefficiente d'uso",
    "given_T0": "periodo dell'elemento, libero di vibrare prima di dondolare",
    "given_soil": "categoria di sottosuolo",
    "given_topography": "categoria topografica",
    "given_z": "quota del piano dalla fondazione",
    "given_H": "altezza dell'edificio",
    "given_T1": "primo periodo dell'edificio, {state}",
    "given_xi1": "smorzamento dell'edificio, come rapporto, {state}",
    "given_n": "numero di piani",
    "ground_at": "Azione sismica allo {state}",
    "free": (
        "L'elemento è libero di vibrare prima di dondolare: ad attivarlo è lo spettro al suo periodo, con il 5 % di "
        "smorzamento."
    ),
    "VR": "periodo di riferimento",
    "TR": "periodo di ritorno allo {state}, con probabilità del {percent:g} % nel periodo di riferimento",
    "r": "posizione di T_[R] tra le due righe della tabella che lo comprendono, sui logaritmi",
    "rock_ag": "accelerazione al suolo su roccia",
    "rock_F0": "amplificazione spettrale massima",
    "rock_TC": "periodo T_[C]^[*] su roccia",
    "S_S": "coefficiente di amplificazione stratigrafica, sottosuolo {soil}",
    "S": "coefficiente di sottosuolo e topografia",
    "C_C": "coefficiente del periodo, sottosuolo {soil}",
    "TC": "fine del tratto ad accelerazione costante dello spettro",
    "TB": "periodo d'inizio del tratto ad accelerazione costante, {state}",
    "TD": "periodo d'inizio del tratto a spostamento costante, {state}",
    "peak": "accelerazione massima del suolo",
    "peak_of_table": "accelerazione massima del suolo, ordinata a T = 0",
    "psi": "forma del primo modo alla quota del piano",
    "gamma": "coefficiente di partecipazione del primo modo",
    "S_Z": "accelerazione massima alla quota",
    "eta": "fattore di smorzamento, ξ in percentuale",
    "eta_T": "la correzione cresce a partire da T = 0",
    "S_e": "ordinata dello spettro di risposta elastico",
    "S_5": "ordinata della tabella al 5 %",
    "A": "amplificazione del piano, ξ_[1] come rapporto",
    "S_eZ": "ordinata dello spettro di risposta alla quota",
    "S_eZ_bound": "oltre T_[1] non minore dello spettro del suolo",
    "S_De": "domanda di spostamento",
    "S_De_long": "domanda di spostamento, tra T_[E] e T_[F]",
    "S_De_ground": "domanda di spostamento, pari a quello del terreno",
    "S_De_floor": "domanda di spostamento alla quota",
    "d_Z": "spostamento del solo spettro alla quota",
    "d_b": "limite oltre b T_[1]: lo spostamento in quel punto",
    "t": "periodo dello spostamento massimo fino a T",
    # chain
    "chain": "Catena cinematica, a riposo",
    "weights": (
        "Pesi che si muovono, M dal file della struttura: P = w M g è portato, P + Q = h M g è mosso in orizzontale, "
        "g = {g} m/s²"
    ),
    "weight": "peso",
    "block": "blocco",
    "of_block_P": "peso portato dal blocco {block}",
    "of_block_PQ": "peso P + Q mosso in orizzontale con il blocco {block}",
    "G": "baricentro di P + Q del blocco {block}",
    "GP": "baricentro di P del blocco {block}",
    "at_work_rest": (
        "Spostamenti virtuali a riposo. Il blocco ruota di θ′ intorno a O: x′ = θ′ (y_[G] − y_[O]) nel verso del moto, "
        "y′ = θ′ {across}"
    ),
    "at_work": (
        "Blocchi a φ = {phi} rad, con la cinematica esatta. Δx è lo spostamento del baricentro di P + Q; "
        "x′ = θ′ (y_[G] − y_[O]), y′ = θ′ {across}"
    ),
    "action": "forza o tirante",
    "held": "Lavoro delle forze F e dei tiranti N negli spostamenti virtuali, r′ nel verso della forza e L′ "
    "l'allungamento",
    "tie": "tirante",
    "ties_at": (
        "Tiranti allo {state}: forza e allungamento; di una forza contraria al moto, lo spostamento del suo punto "
        "contro di essa"
    ),
    "Py": "lavoro dei pesi portati",
    "L": "lavoro delle forze e dei tiranti",
    "V_m": "quanto il meccanismo stesso aggiunge al lavoro, come i carichi tra i suoi dati: si assume assegnato",
    "B_m": "quanto il meccanismo stesso aggiunge all'inerzia: si assume assegnato",
    "PQx": "prima somma dell'inerzia",
    "PQxx": "seconda somma dell'inerzia",
    "PQ": "peso mosso in orizzontale",
    "alpha": "moltiplicatore di collasso",
    "e": "frazione di massa partecipante",
    "M": "massa partecipante",
    "clause not in the code": "non in questa edizione",
    # curve
    "curve": "Curva di capacità",
    "a0": "accelerazione di attivazione del meccanismo",
    "control_barycentre": "spostamento virtuale del punto di controllo, il baricentro di P + Q",
    "control_point": "spostamento virtuale del punto di controllo ({x}; {y}) m di {body}",
    "phi_0": "rotazione per cui il moltiplicatore si annulla, controllata qui sotto",
    "phi": "rotazione per cui si raggiunge lo spostamento, controllata qui sotto",
    "d_C": "spostamento del punto di controllo",
    "d0": "spostamento per cui la capacità si annulla",
    "d_again": "spostamento in quel punto: è quello di {state}",
    "a_there": "accelerazione della curva di capacità in quel punto",
    "state": "{state}, sulla curva di capacità esatta",
    "state_line": "{state}, sulla retta",
    "line_is": "lin: sulla retta da a_[0]^[*] a riposo a d_[0]^[*], anch'essa ammessa dalla norma.",
    "d_state": "spostamento ammesso allo {state}",
    "a_line": "accelerazione della retta in quel punto",
    "a_elastic": "non oltre il ramo elastico di T_[0]",
    "T": "periodo allo {state}",
    "passes": "spostamento ammesso diviso domanda allo {state}: verifica soddisfatta, almeno 1",
    "passes_still": (
        "spostamento ammesso diviso domanda allo {state}: minore di 1, ma verifica soddisfatta, perché il meccanismo "
        "non si attiva"
    ),
    "fails": "spostamento ammesso diviso domanda allo {state}: verifica non soddisfatta, minore di 1",
    # methods
    "method_damage": "Attivazione del meccanismo",
    "method_damage_at": "Attivazione del meccanismo, verifica a {state}",
    "method_linear": "Metodo lineare: fattore di comportamento q",
    "method_nonlinear_at": "Metodo non lineare, verifica a {state}",
    "method_SLD": "Attivazione del meccanismo, verifica a SLD",
    "and_line": "sulla retta",
    "linear_at": "Metodo lineare: q volte l'attivazione del meccanismo, con l'azione dello {state}",
    "mode_of_SLD": "T_[1] e ξ_[1] sono qui quelli dello SLD.",
    "a_g_start": "accelerazione al suolo su roccia che attiva il meccanismo, con l'azione dello {state}",
    "a_g_method": "accelerazione al suolo su roccia sopportata",
    "a_g_start_iterated": (
        "accelerazione al suolo su roccia che attiva il meccanismo, con l'azione dello {state}, per tentativi"
    ),
    "a_g_method_iterated": "accelerazione al suolo su roccia sopportata, per tentativi",
    "check": "Controllo, con l'azione di {state} per questo a_[g]: F_[0], T_[C] e S fissi, T_[D] conseguente.",
    "zeta": "capacità divisa per la domanda allo {state}",
    "TR_capacity": "periodo di ritorno sopportato, per tentativi",
    "check_TR": "Controllo, con l'azione di questo periodo di ritorno:",
    "beyond_long": "Periodo di ritorno: oltre {TR} anni, fine della tabella.",
    "beyond_short": "Periodo di ritorno: meno di {TR} anni, inizio della tabella.",
    # dynamic
    "dynamic": "Metodo dinamico",
    "dynamic_is": (
        "Analisi nel tempo sulla curva di capacità, con restituzione (§C8.7.1.2.1.9): la verifica è soddisfatta se "
        "nessun accelerogramma supera d_[0]^[*] = {d0:.6g} m e la media degli spostamenti massimi non supera quello "
        "ammesso allo {state}, al quale gli accelerogrammi appartengono: non valgono per altri stati limite."
    ),
    "as_given": "Gli accelerogrammi agiscono sulla struttura così come sono assegnati.",
    "carried_to_floor": (
        "Gli accelerogrammi al suolo sono portati alla quota del piano con il primo modo dell'edificio: {floor}, con z "
        "diviso per l'altezza dell'edificio."
    ),
    "carried_by_option": "Gli accelerogrammi al suolo sono portati alla quota assegnata con essi: {floor}.",
    "of_floor": "Gli accelerogrammi sono considerati, come dichiarato, moti del piano e non del suolo.",
    "dynamic_table": "Spostamento massimo d [m]",
    "record": "accelerogramma",
    "with_FC": "con FC",
    "without_FC": "senza FC",
    "overturns": "ribaltamento",
    "past": "oltre d_[0]^[*]",
    "holds": "{which}, {state}: la media di {mean:.6g} m è entro {allowed:.6g} m: verifica soddisfatta.",
    "holds_not": "{which}, {state}: la media di {mean:.6g} m supera {allowed:.6g} m: verifica non soddisfatta.",
    "past_d0": "{which}: verifica non soddisfatta, superano d_[0]^[*]: {names}.",
    "unknown_after": "non noto dopo {time} s",
    "unknown_fails": (
        "{which}, {state}: verifica non soddisfatta. L'esito sotto {names} non è noto, perché si apre o scorre un "
        "giunto che il modello mantiene chiuso: un esito non noto non soddisfa la verifica."
    ),
    "not_checked": (
        "Attenzione: i giunti di questo meccanismo non sono controllati, perché non è noto quali restano chiusi."
    ),
    "few": "Gli accelerogrammi sono {count}: per la media la norma ne chiede almeno {enough}.",
    "one": "L'accelerogramma è uno solo: per la media la norma ne chiede almeno {enough}.",
}

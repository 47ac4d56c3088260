"""The paper's three oils from their own properties, and what they do to its row: wet over dry times of flight without a fitted number.

What the paper gives is the kinematic viscosity at 40 °C and the density. What it does not give is taken as a range:
- temperature of the room, 20 to 40 °C, by ASTM D341 (Walther) with the viscosity at 100 °C of the oil's grade;
- α, 10 to 20 1/GPa: mineral oils at 20 to 40 °C have 15 to 25, poly-α-olefins (a 0W-30) 10 to 15 [Jones et al. 1975; Bair 2007], and the
  reciprocal asymptotic value, which is what builds the film, is some tenths less.
"""

import sys

import numpy as np
from scipy.optimize import brentq

from pulse import CUBIC, RELAXATION, STIFFNESS
from row import shot

# Kinematic viscosities at 40 °C (paper) and about 100 °C (grade: 0W-30 9.3 to 12.5, 80W-90 13.5 to 18.5 cSt [SAE J300, J306]; of a vacuum
# pump oil with a viscosity index near 95) in cSt, density in kg/m³, α in 1/Pa from low to high.
OILS = {
    "pump": (55.0, 7.7, 870.0, (12e-9, 20e-9)),
    "motor": (68.5, 12.0, 842.6, (8e-9, 15e-9)),
    "gear": (133.0, 14.5, 898.0, (12e-9, 22e-9)),
}
USUAL_ALPHA = {"pump": 16e-9, "motor": 11e-9, "gear": 17e-9}
# The paper's effective materials: Y in Pa, η = η1 v0^e in Pa s and ν = ν1 v0^e of the impact speed in m/s.
PAPER = {"pump": (216e9, 81405.3, -0.302, 0.314, -0.274), "motor": (193e9, 66177.1, -0.206, 0.360, -0.165), "gear": (225e9, 107299.0, -0.640, 0.390, -0.127)}
SPEEDS = (0.075, 0.15, 0.3, 0.6, 1.2)
COARSE = {"step": 1.5e-7, "nodes": 200}


def viscosity(oil, celsius):
    """η in Pa s: log10 log10(ν + 0.7) is linear in log10 T [ASTM D341]; density falls by 6.5e-4 of itself a kelvin from 40 °C."""
    at40, at100, density, _ = OILS[oil]
    scale = lambda cst: np.log10(np.log10(cst + 0.7))
    slope = (scale(at100) - scale(at40)) / np.log10(373.15 / 313.15)
    thick = 10 ** 10 ** (scale(at40) + slope * np.log10((celsius + 273.15) / 313.15)) - 0.7
    return thick * 1e-6 * density * (1 - 6.5e-4 * (celsius - 40))


def ratios(oil, speed, dry, preload, wet_cubic=0.0):
    """Wet over dry incident times: usual, least and largest over temperature and α, and isoviscous."""
    losses = (RELAXATION, CUBIC, RELAXATION, wet_cubic)
    run = lambda celsius, alpha: shot(speed, viscosity(oil, celsius), preload, losses=losses, alpha=alpha, **COARSE)[0] / dry
    low, high = OILS[oil][3]
    found = [run(celsius, alpha) for celsius in (20, 40) for alpha in (low, high)]
    return run(25, USUAL_ALPHA[oil]), min(found), max(found), run(25, 0.0)


def effective(oil, speed, preload=0.24):
    """(ν, η) of the material that Hertz and the viscoelastic term would need on wet contacts for the same time and wall peak, Y = 213 GPa."""
    target = shot(speed, viscosity(oil, 25), preload, alpha=USUAL_ALPHA[oil], **COARSE)
    model = lambda stiff, a: shot(speed, None, preload, losses=(RELAXATION, CUBIC, a, 0.0), stiffer=stiff, **COARSE)
    relaxation, stiff = 2 * RELAXATION, 1.1
    for _ in range(6):
        relaxation = brentq(lambda a: model(stiff, a)[2] - target[2], 0.0, 3e-5, xtol=1e-9, rtol=1e-4)
        stiff = brentq(lambda s: model(s, relaxation)[0] - target[0], 0.8, 3.0, rtol=1e-4)
    poisson = np.sqrt(max(1 - (1 - 0.3**2) / stiff, 0.0))
    shear = 4 / 3 * (1 - poisson + poisson**2) + (1 - 2 * poisson) ** 2
    return stiff, poisson, relaxation, relaxation * 213e9 * (1 - poisson) / (1 + poisson) / shear


def paper(oil, speed):
    """(K over the dry one, η in Pa s) by the paper's table."""
    young, eta, eta_power, poisson, power = PAPER[oil]
    return young / (1 - (poisson * speed**power) ** 2) / (213e9 / 0.91), eta * speed**eta_power


def main():
    preload = float(sys.argv[1]) if len(sys.argv) > 1 else 0.24
    print(f"static load {preload} N; η in Pa s at 20, 25, 40 °C:", {oil: [round(float(viscosity(oil, t)), 4) for t in (20, 25, 40)] for oil in OILS})
    print("| oil | v0, m/s | wet/dry | least | largest | α = 0 | with cubic |\n|---|---|---|---|---|---|---|")
    for speed in SPEEDS:
        dry = shot(speed, None, preload, **COARSE)[0]
        for oil in OILS:
            usual, least, largest, plain = ratios(oil, speed, dry, preload)
            losses = (RELAXATION, CUBIC, RELAXATION, CUBIC)
            cubic = shot(speed, viscosity(oil, 25), preload, losses=losses, alpha=USUAL_ALPHA[oil], **COARSE)[0] / dry
            print(f"| {oil} | {speed} | {usual:.4f} | {least:.4f} | {largest:.4f} | {plain:.4f} | {cubic:.4f} |", flush=True)
    print("| oil | v0, m/s | K over dry | paper | ν at 213 GPa | η, Pa s | paper |\n|---|---|---|---|---|---|---|")
    for speed in (0.075, 0.15, 0.3, 1.2):
        for oil in OILS:
            stiff, poisson, _, eta = effective(oil, speed, preload)
            known, thick = paper(oil, speed)
            print(f"| {oil} | {speed} | {stiff:.2f} | {known:.2f} | {poisson:.3f} | {eta:.2g} | {thick:.2g} |", flush=True)


if __name__ == "__main__":
    main()

// Guided scenes: a minute each, some steps, a question at the end.

import { plain, quantity } from "./numbers.js";

const micro = (seconds) => `${plain(seconds * 1e6, 5)} µs`;
const set = (path, value) => ({ path, value });

/**
 * A scene has steps of {text, preset, edits, view}: the row that a step shows, changes to it, and how
 * it is shown. A text is words, or a function of the page's state, so that no number is typed in.
 */
export const SCENES = [
  {
    id: "wave",
    title: "The solitary wave and its −1/5",
    steps: [
      {
        preset: "hertz",
        view: { curveScale: "linear", curveView: "tof", play: true },
        text: "A ball hits a row of 40 that just touch. One pulse runs down the row, about five beads long, and keeps its shape: a solitary wave. It exists because the contact F = K δ^{3/2} has no stiffness at rest, so there is no sound to run ahead of it.",
      },
      {
        edits: [set(["striker", "speed"], "1 m/s")],
        text: (state) => `Twice the speed, and the pulse is faster, but not by much: the incident time of flight is now ${micro(state.shot?.tof_incident_s)}. Pull the slider of the striker’s speed and watch the time follow the curve.`,
      },
      {
        view: { curveScale: "log" },
        text: (state) => `On logarithmic axes the curve is a straight line. Its slope is ${plain(state.curve?.power_law_incident?.exponent, 7)}: the time goes as v^{−1/5}, exactly, for any row of spheres without losses.`,
      },
    ],
    question: "By which factor must the striker be faster for half the time of flight?",
    answer: "By 2⁵ = 32. A row is a slow-changing clock, which is why times must be measured to a part in a thousand before they say anything of the contacts.",
  },
  {
    id: "cradle",
    title: "Newton’s cradle is not pairwise collisions",
    steps: [
      {
        preset: "newtons-cradle",
        view: { play: true },
        text: "Five balls on threads. If balls collided two by two, each would hand its whole speed to the next, and the last alone would fly off with the striker’s 0.5 m/s, while all others rest.",
      },
      {
        text: (state) => `Contacts last, and several are closed at once, so the speeds at the end are ${ends(state)}: three balls move back, the fourth follows the last one, and the last is slower than the striker was. Herrmann and Seitz described this in 1982.`,
      },
      {
        edits: [set(["beads", 0, "count"], 9), set(["title"], "Newton's cradle with ten balls")],
        text: (state) => `With ten balls more of them take part in the break-up: ${ends(state)}. The energy is still all there; look at the budget.`,
      },
    ],
    question: "Why does a real cradle look like pairwise collisions all the same?",
    answer: "The balls that were left behind drift apart slowly; after some swings the gaps between them make the next collisions nearly pairwise. Put a gap of 10 µm on every contact to see it: then the last ball gets almost everything.",
  },
  {
    id: "dimer",
    title: "A light intruder, and a dimer",
    steps: [
      {
        preset: "light-intruder",
        view: { play: true },
        text: "One bead in the middle, bead 20, has half the radius and an eighth of the mass. The pulse arrives, and the light bead rattles between its neighbours: see the waves that leave it in the map of contact forces.",
      },
      {
        edits: [set(["beads", 1, "radius"], "9 mm"), set(["beads", 1, "mass"], "24.3 g"), set(["title"], "One heavy bead in a uniform chain")],
        text: "A heavy intruder instead reflects a part of the pulse at once, and lets the rest through as several smaller pulses.",
      },
      {
        preset: "dimer-steel-ptfe",
        text: "Steel and PTFE by turns: a dimer. Its pulse is wide, as soft as the softer material makes it, and again a solitary wave in one of the special ratios of masses; elsewhere it radiates as it runs.",
      },
    ],
    question: "Where is a light intruder felt first: in the incident or in the reflected time of flight?",
    answer: "In the incident one, as the pulse must pass it on its way to the wall; but the trapped rattling sheds a train of small waves, which add maxima between the pulses. Look for them in the signals.",
  },
  {
    id: "energy",
    title: "Where the energy goes",
    steps: [
      {
        preset: "hertz",
        view: { whole: true },
        text: "Without losses energy is only passed on: kinetic and elastic by turns. In a solitary wave 5/9 is kinetic; at the wall nearly all is elastic for a moment.",
      },
      {
        preset: "hertz-viscoelastic",
        text: (state) => `Steel that creeps a little: the viscoelastic term takes ${lost(state)} of the energy, contact by contact, and the reflected pulse is later and lower than the incident one.`,
      },
      {
        preset: "dry",
        text: (state) => `The paper adds a term in the cube of the rate, F = B δ̇³. Now ${lost(state)} is lost. The cubic term counts where the rate is large: where the striker hits.`,
      },
    ],
    question: "Which of the two losses would you expect to matter more at 0.1 m/s, and which at 2 m/s? Try.",
    answer: "The viscoelastic share changes slowly with speed, as v^{1/5}; the cubic one grows much more quickly. Fast shots are where B shows, slow ones where η does.",
  },
  {
    id: "oil",
    title: "A drop of oil",
    steps: [
      {
        preset: "dry",
        view: { curveView: "tof", curveScale: "log" },
        text: "The paper’s dry row. Now a drop of motor oil goes on every contact from the sensor bead to the wall.",
      },
      {
        preset: "motor",
        view: { curveView: "ratio", curveScale: "log", reference: "dry" },
        text: "The ratio of times, wet over dry: the oil changes the incident time by a few per cent, with a sign that depends on the speed, and the reflected one by more. The curve is the paper’s model with an effective modulus and viscosity for this oil.",
      },
      {
        preset: "gear",
        view: { curveView: "ratio", curveScale: "log", reference: "dry" },
        text: "Gear oil has the highest viscosity of the three, and its incident pulse is the fastest: the ratio stays below 1. The reflected pulse is late all the same, but for the fastest shots.",
      },
      {
        preset: "pump",
        view: { curveView: "ratio", curveScale: "log", reference: "dry" },
        text: "Pump oil crosses 1 within the range of speeds. One number, measured to a part in a thousand, tells oils apart.",
      },
    ],
    question: "Does a more viscous oil make the row slower?",
    answer: "Not by itself. Gear oil is 2.4 times as viscous as pump oil, and the incident pulse is faster in it: a film squeezed in microseconds stiffens the contact as well as it damps it.",
  },
  {
    id: "gaps",
    title: "Gaps and preload",
    steps: [
      {
        preset: "hertz",
        view: { curveScale: "log", curveView: "tof", reference: "hertz", play: true },
        text: "A row that just touches, once more. Between bead 20 and 21 now comes a gap of 20 µm, a third of a hair.",
      },
      {
        edits: [set(["gaps"], [{ contact: 20, gap: "20 um" }]), set(["title"], "A gap of 20 µm behind bead 20")],
        view: { play: true },
        text: "Bead 20 must fly across the gap: the pulse is late, the later the slower the shot. The slope of the curve is no longer −1/5; dashed is the row without the gap.",
      },
      {
        preset: "hertz",
        edits: [set(["near_end"], { push: "constant", force: "30 N" }), set(["title"], "A preload of 30 N")],
        view: { curveScale: "log", curveView: "tof", reference: "hertz" },
        text: (state) => `A push of 30 N instead closes every contact, and there is sound: slow shots all take the same time. The slope falls to ${plain(state.curve?.power_law_incident?.exponent, 3)} over this range, and flattens to 0 at the slow end.`,
      },
    ],
    question: "Which of the two would you rather have in an experiment that you do not know about: gaps or preload?",
    answer: "Neither is harmless, but both show in the slope: gaps make slow shots too slow, a preload makes them too fast. Measure over a wide range of speeds and look at the exponent first.",
  },
  {
    id: "taper",
    title: "A taper that protects",
    steps: [
      {
        preset: "tapered",
        view: { whole: true, play: true },
        text: "Each bead is 5 % smaller than the one before. The pulse meets ever lighter beads and speeds up: its ridge in the map of forces bends.",
      },
      {
        text: (state) => `The largest force is ${quantity(peak(state, 0), "N", 3)} in the first contact and ${quantity(peak(state, -1), "N", 3)} in the last one. What hits hard at one end arrives as a faster, weaker and shorter push.`,
      },
      {
        edits: [set(["beads", 0, "radius_ratio"], 0.9), set(["title"], "Tapered chain: each bead 10 % smaller than the one before")],
        text: (state) => `With 10 % a bead: ${quantity(peak(state, 0), "N", 3)} against ${quantity(peak(state, -1), "N", 3)}. The small beads at the end fly off fast, and carry little.`,
      },
    ],
    question: "The energy is all there. In which sense does the taper protect?",
    answer: "The force and the momentum at the end are smaller, and the striker leaves momentum all along the row. Add losses (a viscoelastic law) and the many fast contacts of small beads also turn energy into heat.",
  },
];

/** Speeds of all balls at the end. */
function ends(state) {
  const all = (state.shot?.bodies ?? []).map((body) => state.shot.velocity_m_s[body.number]);
  return `${all.map((speed) => plain(speed, 3)).join(", ")} m/s`;
}

/** The share of the energy that was lost, in words. */
function lost(state) {
  const energy = state.shot?.energy;
  if (!energy) return "–";
  const gone = energy.parts.filter(([name]) => !["kinetic", "elastic", "gravity", "preload", "stop"].includes(name));
  return `${plain((100 * gone.reduce((sum, [, values]) => sum + values[values.length - 1], 0)) / energy.input_j, 3)} %`;
}

/** The largest force of a contact, counted from either end. */
function peak(state, contact) {
  const { motion } = state;
  if (!motion) return NaN;
  const at = contact < 0 ? motion.contacts + contact : contact;
  return motion.force.subarray(at * motion.samples, (at + 1) * motion.samples).reduce((most, one) => Math.max(most, one), 0);
}

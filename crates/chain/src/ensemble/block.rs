//! Shots side by side, or one alone: all that changes from step to step.

use super::aligned::Aligned;
use super::behind::Behind;
use super::bodies::{LaneMotion, LanePace, LaneScaled, unit_per_kg};
use super::changes::{Changes, Opening};
use super::column::{LaneColumn, chunks};
use super::edge::{Edge, Leading};
use super::number::Number;
use super::section::{Sweep, SweepPlace, section};
use super::weights::{Schedule, USED, ahead_of};
use super::window::{LaneWindow, Places};
use crate::chain::Tension;
use crate::instruction_set::InstructionSet;
use crate::laws::Closed;
use crate::sensor::Sensor;
use crate::system::System;
use fearless_simd::{dispatch, prelude::*};

/// Edges below this fraction of the shot's speed are left as they are.
const SLIGHT: f64 = 1e-10;

/// Steps before an opening at which a force that pulls does so.
const SOON: f64 = 0.1;

/// How far apart bodies are set that have been left behind: further than any
/// overlap or way, in any unit, and no limit of what numbers can hold.
const APART: f64 = 1e20;

/// Most edges that disturb steps at a time without memory being asked for.
const RESERVED: usize = 1024;

/// Where the bodies of a block are; of fields, so that others can change.
macro_rules! places {
    ($block:expr) => {
        Places {
            offset_m: $block.offset_m.reader(),
            x: &$block.motion.x,
            v: &$block.motion.v,
            lanes: $block.lanes,
        }
    };
}

pub(super) struct Block<'a, N, const W: usize> {
    systems: &'a [&'a System],
    lanes: usize,
    set: InstructionSet,
    schedule: &'a Schedule,
    paces: [LanePace; W],
    weights: LaneScaled<N, W>,
    motion: LaneMotion<N, W>,
    offset_m: LaneColumn<N, W>,
    slightest_m: [N; W],
    /// Minus the static forces; `None` where there are none.
    at_rest: Option<Aligned<N>>,
    sections: Vec<Box<dyn Sweep<N, W>>>,
    /// Dynamic force of contact c at (c + 1) · lanes; 0 before the first.
    force_n: Aligned<N>,
    window: LaneWindow,
    changes: Option<Changes<W>>,
    /// Edges that still disturb steps: where, the edge, steps since.
    edges: Vec<(usize, Edge, usize)>,
    starting: bool,
    /// Steps made.
    pub steps: usize,
    /// Bodies of all lanes looked at, summed over steps.
    pub bodies_looked_at: u64,
}

/// A number of every body of all lanes, in so many places; lanes alternate.
fn scattered<N: Number<W>, const W: usize>(
    systems: &[&System],
    places: usize,
    of: fn(&System) -> &[f64],
) -> Aligned<N> {
    let mut values = Aligned::of(N::default(), places);
    for (lane, system) in systems.iter().enumerate() {
        for (j, value) in of(system).iter().enumerate().filter(|(_, value)| **value != 0.0) {
            values[j * systems.len() + lane] = N::of(*value);
        }
    }
    values
}

impl<'a, N: Number<W>, const W: usize> Block<'a, N, W> {
    /// Shots of systems that share their shape; one or `W` of them.
    pub(super) fn new(
        systems: &'a [&'a System],
        step_s: &[f64],
        schedule: &'a Schedule,
        set: InstructionSet,
        (whole_chain, follow_changes): (bool, bool),
    ) -> Self {
        let (lanes, first) = (systems.len(), systems[0]);
        let bodies = first.bodies();
        // What lanes share is set up once.
        let chains = match systems.iter().all(|system| system.is_chain_of(first)) {
            true => &systems[..1],
            false => systems,
        };
        let shared = (lanes, chains.len());
        let flat = (chunks::<W>(bodies, lanes) + 1) * W;
        let x: Aligned<N> = scattered(systems, flat, |system| &system.displacement_m);
        let v: Aligned<N> = scattered(systems, flat, |system| &system.velocity_m_s);
        let mut loads = chains.iter().flat_map(|system| system.static_force_n.iter());
        let loaded = loads.any(|&force| force != 0.0);
        let acts = first.slope_m_s2 != 0.0 || first.spring.is_some() || first.pendulum_per_s2 > 0.0;
        let offset_m = LaneColumn::new(first.contacts(), shared, f64::NEG_INFINITY, |c, lane| {
            chains[lane].offset_m[c]
        });
        let scales: [_; W] = std::array::from_fn(|lane| systems[lane % lanes].scales());
        let slightest_m = scales.map(|scales| N::slightest_m(scales.speed_m_s * scales.time_s));
        let paces = std::array::from_fn(|lane| LanePace {
            step_s: step_s[lane % lanes],
            ahead: ahead_of(step_s[lane % lanes] / scales[lane].time_s),
            unit_per_kg: unit_per_kg(systems[lane % lanes]),
        });
        let fixed = systems.iter().all(|system| system.ends_fixed());
        let moving = bodies - usize::from(fixed);
        let window = LaneWindow::new((lanes, chains), (&x, &v), moving, whole_chain);
        let inverse_mass = LaneColumn::new(moving, shared, 0.0, |j, lane| {
            chains[lane].inverse_mass[j] / unit_per_kg(chains[lane])
        });
        let mut block = Self {
            edges: Vec::with_capacity(RESERVED),
            changes: follow_changes.then(|| Changes::new(chunks::<W>(bodies, lanes))),
            window,
            motion: LaneMotion::new(x, v, inverse_mass, acts),
            weights: LaneScaled::new(schedule.row(0), &paces),
            at_rest: loaded.then(|| Aligned::of(N::default(), flat)),
            sections: (0..first.sections.len()).map(|i| section((systems, chains), i)).collect(),
            force_n: Aligned::of(N::default(), flat + W),
            paces,
            offset_m,
            slightest_m,
            systems,
            lanes,
            set,
            schedule,
            starting: true,
            steps: 0,
            bodies_looked_at: 0,
        };
        block.rest();
        block.forces();
        if let Some(changes) = block.changes.take() {
            block.look_at_changes(changes, false);
        }
        block
    }

    /// Takes the static forces from the laws as this loop computes them: what
    /// rests then feels no force to the last bit, however many chunks move.
    fn rest(&mut self) {
        if self.at_rest.is_none() {
            return;
        }
        let still = || Aligned::of(N::default(), self.motion.x.len());
        let (no_x, no_v, whole) = (still(), still(), self.window.whole());
        let x = std::mem::replace(&mut self.motion.x, no_x);
        let v = std::mem::replace(&mut self.motion.v, no_v);
        let window = std::mem::replace(&mut self.window, whole);
        self.forces();
        let force = &mut self.force_n[self.lanes..];
        for (at_rest, force) in
            self.at_rest.iter_mut().flat_map(|at_rest| at_rest.iter_mut()).zip(force)
        {
            *at_rest = N::of(-std::mem::take(force).into());
        }
        (self.motion.x, self.motion.v, self.window) = (x, v, window);
    }

    /// One step of all lanes; the forces are then those of the new positions.
    #[inline(always)]
    pub(super) fn step<S: Simd>(&mut self, simd: S) {
        // What few chains need is not even called for the others.
        if let Some(external) = self.motion.external.take() {
            self.push(external);
        }
        if self.steps <= self.schedule.last_row() {
            self.weights = LaneScaled::new(self.schedule.row(self.steps), &self.paces);
        }
        self.motion.step(simd, &self.window, self.lanes, &self.force_n, &self.weights);
        if !self.edges.is_empty() {
            self.correct_edges();
        }
        if self.systems[0].periodic {
            self.close_ring();
        }
        self.window.follow(simd, places!(self));
        self.starting = false;
        self.forces();
        if let Some(changes) = self.changes.take() {
            self.look_at_changes(changes, true);
        }
        self.steps += 1;
        self.bodies_looked_at += (self.window.bodies.len() * W) as u64;
    }

    pub(super) fn forces(&mut self) {
        let lanes = self.lanes;
        let awake = self.window.contacts.clone();
        let force = &mut self.force_n[lanes..][..awake.end * W];
        let flat = awake.start * W..awake.end * W;
        // With all lanes and no load each chunk belongs to one section.
        let fresh = lanes == W && self.at_rest.is_none();
        match &self.at_rest {
            Some(at_rest) => force[flat.clone()].copy_from_slice(&at_rest[flat]),
            None if !fresh => force[flat].fill(N::default()),
            None => {}
        }
        let place = SweepPlace {
            offset_m: &self.offset_m,
            slightest_m: self.slightest_m,
            lanes,
            awake,
            fresh,
            starting: self.starting,
            x: &self.motion.x,
            v: &self.motion.v,
        };
        let open = self.changes.as_mut().map(|changes| &mut changes.now[..]).unwrap_or_default();
        for section in &mut self.sections {
            section.add(self.set, &place, force, open);
        }
        if self.systems[0].periodic {
            let last = self.systems[0].contacts() * lanes;
            self.force_n.copy_within(last..last + lanes, lanes);
        }
    }

    /// Lets sleep what stays as it is for a number of steps.
    pub(super) fn look(&mut self, steps: usize) {
        let ahead_s = self.paces.map(|pace| N::of((steps + 1) as f64 * pace.step_s));
        self.window.look(self.set, places!(self), &ahead_s);
    }

    /// Lets go of what each lane's reflected pulse has left behind.
    pub(super) fn leave_behind(&mut self, behind: &mut Behind<W>) {
        let force = &self.force_n[self.lanes..];
        let left = behind.look(self.set, force, self.window.contacts.clone());
        for (lane, bodies) in left {
            for body in bodies {
                let at = body * self.lanes + lane;
                self.motion.set_apart(at, N::of(APART * (body + 1) as f64));
                // Of the contact on its left.
                self.force_n[at] = N::default();
                if let Some(changes) = &mut self.changes {
                    changes.opened(at - self.lanes);
                }
            }
        }
    }

    /// Finds openings and closings within the last step.
    fn look_at_changes(&mut self, mut changes: Changes<W>, follow: bool) {
        let awake = self.window.contacts.clone();
        let changed = changes.look(awake);
        if follow && self.steps > self.schedule.last_row() {
            for &at in changed {
                if let Some(edge) = self.edge(at) {
                    self.correct(at, &edge, 0);
                    self.edges.push((at, edge, 1));
                }
            }
            if self.systems[0].periodic {
                self.close_ring();
            }
        }
        self.changes = Some(changes);
    }

    /// The edge of the force of a contact that has opened within the last
    /// step, if it is worth mending.
    fn edge(&self, at: usize) -> Option<Edge> {
        let lanes = self.lanes;
        let (contact, lane) = (at / lanes, at % lanes);
        let system = self.systems[lane];
        if !system.has_contact(contact) {
            return None;
        }
        let h = self.paces[lane].step_s;
        let [x, v] = [&self.motion.x, &self.motion.v]
            .map(|values| [values[at], values[at + lanes]].map(Into::<f64>::into));
        let bodies = self.sides(contact);
        let [left, right] = bodies.map(|body| {
            let [before, after] = [body, body + 1]
                .map(|contact| Into::<f64>::into(self.force_n[contact * lanes + lane]));
            (before - after) * system.inverse_mass[body]
        });
        let opening = Opening {
            depth_m: system.offset_m[contact] - (x[1] - x[0]),
            rate_m_s: v[0] - v[1],
            change_m_s2: left - right,
        };
        let since = opening.since_s(h)?;
        let before = |steps: f64| {
            let (depth, rate) = opening.at(since + steps * h);
            system.unclipped_force(contact, Closed::new(depth, rate))
        };
        // A force that pulls and is cut at 0 ends earlier, and not sharply.
        if system.tension == Tension::Clipped && before(SOON) < 0.0 {
            return None;
        }
        let leading = Leading::new(before);
        let [left, right] = bodies.map(|body| system.inverse_mass[body]);
        let kick = leading.size() * h * left.max(right);
        let matters = kick > SLIGHT * system.scales().speed_m_s;
        let weights = (self.schedule.steady(), self.paces[lane].ahead);
        matters.then(|| Edge::ending(&leading, 1.0 - since / h, weights))
    }

    /// Gives the last step what earlier edges made it lack, before its forces.
    fn correct_edges(&mut self) {
        let mut edges = std::mem::take(&mut self.edges);
        for (at, edge, age) in &mut edges {
            self.correct(*at, edge, *age);
            *age += 1;
        }
        edges.retain(|(_, _, age)| *age < USED);
        self.edges = edges;
    }

    /// Gives the last step what an edge of some age made it lack.
    fn correct(&mut self, at: usize, edge: &Edge, age: usize) {
        let (contact, lane) = (at / self.lanes, at % self.lanes);
        let h = self.paces[lane].step_s;
        let [sped, moved] = [edge.lacking[age][0] * h, edge.lacking[age][1] * h * h];
        for (body, sign) in self.sides(contact).into_iter().zip([-1.0, 1.0]) {
            let push = sign * self.systems[lane].inverse_mass[body];
            let at = body * self.lanes + lane;
            self.motion.v[at] = N::of(self.motion.v[at].into() + push * sped);
            self.motion.x[at] = N::of(self.motion.x[at].into() + push * moved);
        }
    }

    /// The bodies that a contact moves: in a ring bead 1 follows the last.
    fn sides(&self, contact: usize) -> [usize; 2] {
        let first = self.systems[0];
        match first.periodic && contact + 2 == first.bodies() {
            true => [contact, 1],
            false => [contact, contact + 1],
        }
    }

    /// In a ring the last body is bead 1 again.
    fn close_ring(&mut self) {
        let (lanes, last) = (self.lanes, self.systems[0].bodies() - 1);
        for values in [&mut self.motion.x, &mut self.motion.v] {
            values.copy_within(lanes..2 * lanes, last * lanes);
        }
        self.motion.newest_mut().copy_within(lanes..2 * lanes, last * lanes);
    }

    /// What acts on single bodies beside contacts: the striker's weight, the
    /// spring on bead 1, threads.
    fn push(&mut self, mut external: Aligned<N>) {
        for (lane, system) in self.systems.iter().enumerate() {
            let bodies = if system.pendulum_per_s2 > 0.0 { system.bodies() } else { 2 };
            for body in 0..bodies {
                let at = body * self.lanes + lane;
                let pushed = system.pushed(body, self.motion.x[at].into());
                external[at] = N::of(pushed / self.paces[lane].unit_per_kg);
            }
        }
        self.motion.external = Some(external);
    }

    /// What a sensor shows now in every lane.
    #[inline(always)]
    pub(super) fn signals<const LANES: usize>(&self, sensor: Sensor) -> [N; LANES] {
        let row = |values: &[N], at: usize| -> [N; LANES] {
            let row = values[at * LANES..].first_chunk();
            row.copied().unwrap_or([N::default(); LANES])
        };
        let force = |contact: usize| row(&self.force_n, contact + 1);
        // In a ring the contact before bead 1 is the last, whose force is also
        // kept in the place of contact 0.
        let bead = |n: usize| {
            let (left, right) = (force(n - 1), force(n));
            std::array::from_fn(|lane| N::of(0.5) * (left[lane] + right[lane]))
        };
        match sensor {
            Sensor::Bead(n) => bead(n),
            Sensor::Contact(c) => force(c),
            Sensor::Position(i) => row(&self.motion.x, i),
            Sensor::Velocity(i) => row(&self.motion.v, i),
            Sensor::BeadPlusWall(n) => {
                let (bead, wall) = (bead(n), force(self.systems[0].contacts() - 1));
                std::array::from_fn(|lane| bead[lane] + wall[lane])
            }
        }
    }

    /// Steps for which no contact of a lane is closed, if nothing but contacts acts; else 0.
    pub(super) fn fly_for(&self, lane: usize) -> f64 {
        let system = self.systems[lane];
        let [x, v] = [&self.motion.x, &self.motion.v];
        let of = |values: &[N], body: usize| values[body * self.lanes + lane].into();
        let touches_s = |contact: usize| -> f64 {
            let apart_m = of(x, contact + 1) - of(x, contact) - system.offset_m[contact];
            let rate_m_s = of(v, contact) - of(v, contact + 1);
            match (apart_m >= 0.0, rate_m_s > 0.0) {
                (false, _) => 0.0,
                (true, true) => apart_m / rate_m_s,
                (true, false) => f64::INFINITY,
            }
        };
        let until_s = match system.flies_free() {
            true => (0..system.contacts()).map(touches_s).fold(f64::INFINITY, f64::min),
            false => 0.0,
        };
        until_s / self.paces[lane].step_s
    }

    /// Velocities of all bodies of a lane in m/s.
    pub(super) fn velocities(&self, lane: usize) -> impl Iterator<Item = f64> + '_ {
        let v = &self.motion.v;
        (0..self.systems[0].bodies()).map(move |body| v[body * self.lanes + lane].into())
    }

    /// How much correcting the last step changed any velocity of each lane, in
    /// m/s; NaN where anything is.
    pub(super) fn corrections(&self) -> [f64; W] {
        let worst = dispatch!(self.set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.worst_correction(simd)
        ));
        std::array::from_fn(|lane| {
            let own = (lane..W).step_by(self.lanes).map(|at| worst[at].into());
            let pace = self.paces[lane];
            pace.step_s * pace.unit_per_kg * own.fold(0.0, larger_or_nan)
        })
    }

    #[inline(always)]
    fn worst_correction<S: Simd>(&self, simd: S) -> [N; W] {
        let weights = &self.schedule.row(self.steps.saturating_sub(1)).residual;
        let wide = |value: f64| N::Wide::<S>::simd_from(simd, N::of(value));
        let mut worst = wide(0.0);
        for chunk in self.window.bodies.clone() {
            let mut change = wide(0.0);
            for (age, &weight) in weights.iter().enumerate() {
                let a = &self.motion.accelerations(age)[chunk * W..][..W];
                change = wide(weight).mul_add(N::Wide::<S>::from_slice(simd, a), change);
            }
            let change = change.abs();
            // What is not at most the worst is larger, or NaN and stays so.
            let smaller = change.simd_le(worst) | worst.simd_ne(worst);
            worst = smaller.select(worst, change);
        }
        let mut lanes = [N::default(); W];
        worst.store_array(&mut lanes);
        lanes
    }
}

/// The larger of two; NaN, which `max` would lose, if either is.
fn larger_or_nan(one: f64, other: f64) -> f64 {
    if other <= one || one.is_nan() { one } else { other }
}

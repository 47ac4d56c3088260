//! The chain on its track from impact to impact, and the shots of a series.

use crate::rig::instruments::{GateReading, programmed, true_speed_m_s};
use crate::rig::recorder::{ForceTrace, Record, TraceObserver, Window};
use crate::rig::{Plan, Purpose, RandomStream, RigError, Series};
use crate::{StudyError, stopped};
use hertzchain_chain::observe::Passages;
use hertzchain_chain::settle::{Rest, SlowPhase, State, settle};
use hertzchain_chain::wave::{Limits, Method, Outcome, run};
use hertzchain_chain::{Chain, Sensor, System};
use hertzchain_experiment::{Campaign, Experiment};

/// How far away the striker waits, in m: out of everything's way.
const STRIKER_WAITS_M: f64 = 0.01;

/// Largest deviation of a bead's radius from the file's, as a share of it.
const LARGEST_DEVIATION: f64 = 0.5;

/// Largest error per step of the wave. Incident times of flight of the paper's chains
/// are right to 10 ps, reflected ones to half a nanosecond.
const TOLERANCE: f64 = 1e-8;

/// The wave loop hands over to the slow scheme when the reflected pulse has
/// passed the sensor, or after this time in s.
const LONGEST_WAVE_S: f64 = 0.02;

/// An assembled chain with the state in which the last impact has left it.
#[derive(Clone, Debug)]
pub(crate) struct Bench<'a> {
    experiment: &'a Experiment,
    /// Radii of all beads over the file's.
    sizes: Vec<f64>,
    slow: SlowPhase,
    /// The chain as taps find it: materials may depend on the speed.
    tapped: System,
    state: State,
}

impl<'a> Bench<'a> {
    /// Assembles the chain with random sizes and gaps, and relaxes it to rest.
    ///
    /// # Errors
    /// A chain that can't be built or does not come to rest.
    pub(crate) fn assemble(
        experiment: &'a Experiment,
        random: &mut RandomStream,
    ) -> Result<Self, StudyError> {
        let campaign = experiment.campaign();
        let (laying, beads) = (&campaign.laying, experiment.beads());
        let size = |random: &mut RandomStream| {
            let deviation = laying.radius_spread * random.normal();
            1.0 + deviation.clamp(-LARGEST_DEVIATION, LARGEST_DEVIATION)
        };
        let sizes: Vec<f64> = (0..beads).map(|_| size(random)).collect();
        let tapped = System::new(&chain(experiment, &sizes, campaign.tap_speed_m_s)?)?;
        // None before bead 1, where the striker comes.
        let gap_m = |_| laying.gap_scatter_m * random.exponential();
        let gaps_m: Vec<f64> = std::iter::once(0.0).chain((0..beads).map(gap_m)).collect();
        let mut state = State::laid(&tapped, &gaps_m);
        state.displacement_m[0] -= STRIKER_WAITS_M;
        let slow = SlowPhase {
            friction_coefficient: experiment.friction_coefficient(),
            ..SlowPhase::default()
        };
        settle(&tapped, &mut state, &slow, &mut |_, _, _| {})?;
        let mut bench = Self { slow, experiment, sizes, tapped, state };
        bench.hold_wall();
        Ok(bench)
    }

    /// Strikes one tap with a speed in m/s and relaxes to rest.
    ///
    /// # Errors
    /// A chain that does not come to rest.
    pub(crate) fn tap(&mut self, speed_m_s: f64) -> Result<Rest, StudyError> {
        self.state.strike(&self.tapped, speed_m_s);
        let rest = settle(&self.tapped, &mut self.state, &self.slow, &mut |_, _, _| {})?;
        self.hold_wall();
        Ok(rest)
    }

    /// Returns the chain for a shot of this speed in m/s in its own equilibrium, and as it is:
    /// the striker touches bead 1.
    ///
    /// # Errors
    /// A chain that can't be built at this speed.
    pub(crate) fn systems(&self, speed_m_s: f64) -> Result<(System, System), StudyError> {
        let system = System::new(&chain(self.experiment, &self.sizes, speed_m_s)?)?;
        let mut state = self.state.clone();
        state.strike(&system, speed_m_s);
        let shot = system.from_state(&state)?;
        Ok((system, shot))
    }

    /// Relaxes from where a shot has left the bodies; `observe` gets the time in s from there
    /// and the forces of contacts 0..=N in N.
    fn relax(
        &mut self,
        system: &System,
        state: State,
        observe: &mut dyn FnMut(f64, &[f64]),
    ) -> Result<Rest, StudyError> {
        self.state = state;
        let mut seen = |time_s: f64, _: &State, forces_n: &[f64]| observe(time_s, forces_n);
        let rest = settle(system, &mut self.state, &self.slow, &mut seen)?;
        self.hold_wall();
        Ok(rest)
    }

    /// Gaps in m of contacts 1..=N; 0 where closed.
    pub(crate) fn gaps_m(&self) -> Vec<f64> {
        let overlap_m = |contact| self.state.overlap_m(&self.tapped, contact);
        let gap_m = |contact| (-overlap_m(contact)).max(0.0);
        (1..self.tapped.contacts()).map(gap_m).collect()
    }

    /// Positions and velocities of all bodies.
    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    /// Holds a stop that an impact has pushed a little where it belongs, and the chain with it.
    fn hold_wall(&mut self) {
        let pushed_m = self.state.displacement_m.last().copied().unwrap_or(0.0);
        for displacement_m in &mut self.state.displacement_m {
            *displacement_m -= pushed_m;
        }
    }
}

/// The chain at a speed with the sizes of its beads; masses go with the third power.
fn chain(experiment: &Experiment, sizes: &[f64], speed_m_s: f64) -> Result<Chain, StudyError> {
    let (mut chain, _) = experiment.chain(Some(speed_m_s))?;
    for (bead, size) in chain.beads.iter_mut().zip(sizes) {
        bead.radius_m *= size;
        bead.mass_kg *= size * size * size;
    }
    Ok(chain)
}

/// What happened in the chain.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Incident time of flight in s, by peaks; NaN if no pulse was seen.
    pub incident_s: f64,
    /// Reflected time of flight in s; NaN likewise.
    pub reflected_s: f64,
    /// Times in s after the first touch of the incident, the wall's and the
    /// reflected peak.
    pub peaks_s: [f64; 3],
    /// Their heights in N.
    pub peaks_n: [f64; 3],
    /// Velocity in m/s with which the striker went for good; negative is away
    /// from the chain, NaN if it stayed at it.
    pub rebound_m_s: f64,
    /// Positions and velocities before the shot, the striker wherever it had been left.
    pub before: State,
    /// And after it.
    pub after: State,
    /// Gaps in m of contacts 1..=N before the shot.
    pub gaps_before_m: Vec<f64>,
    /// And after it.
    pub gaps_after_m: Vec<f64>,
    /// Overlaps in m of contacts 1..=N before the shot, negative across a gap: the loads
    /// that friction held, by the contacts' law at the shot's speed.
    pub overlaps_before_m: Vec<f64>,
    /// When the chain was at rest again, in s after the first touch.
    pub rest_s: f64,
}

/// Runs a shot with a speed in m/s and traces the forces of both sensors.
///
/// # Errors
/// A shot that can't be computed.
pub(crate) fn shoot(
    bench: &mut Bench<'_>,
    sensor_bead: usize,
    speed_m_s: f64,
    trace: &mut ForceTrace,
) -> Result<Shot, StudyError> {
    let (before, gaps_before_m) = (bench.state().clone(), bench.gaps_m());
    let (system, shot) = bench.systems(speed_m_s)?;
    let wall = shot.beads();
    let overlaps_before_m = (1..=wall).map(|contact| before.overlap_m(&system, contact));
    let overlaps_before_m = overlaps_before_m.collect();
    let mut passages = Passages::new(sensor_bead, wall, true);
    let outcome = {
        let sensors = [Sensor::Bead(sensor_bead), Sensor::Contact(wall)];
        let mut tracer = TraceObserver { trace, sensors };
        let method = Method::dormand_prince(TOLERANCE);
        let limits = Limits::until(LONGEST_WAVE_S);
        run(&shot, &method, limits, &mut [&mut passages, &mut tracer])?
    };
    let rest = relax(bench, (&system, &shot), &outcome, sensor_bead, trace)?;
    let [incident, wall, reflected] = peaks(&passages);
    Ok(Shot {
        incident_s: wall.0 - incident.0,
        reflected_s: reflected.0 - wall.0,
        peaks_s: [incident.0, wall.0, reflected.0],
        peaks_n: [incident.1, wall.1, reflected.1],
        rebound_m_s: rest.withdrawn.map_or(f64::NAN, |striker| striker.velocity_m_s),
        before,
        after: bench.state().clone(),
        gaps_before_m,
        gaps_after_m: bench.gaps_m(),
        overlaps_before_m,
        rest_s: outcome.time_s + rest.time_s,
    })
}

/// Relaxation after a wave, on the same force trace.
fn relax(
    bench: &mut Bench<'_>,
    (system, shot): (&System, &System),
    outcome: &Outcome,
    sensor_bead: usize,
    trace: &mut ForceTrace,
) -> Result<Rest, StudyError> {
    let contacts = [sensor_bead - 1, sensor_bead, shot.beads()];
    let still_n = contacts.map(|contact| shot.static_contact(contact).force_n);
    let mut push = |time_s: f64, forces_n: &[f64]| {
        let moving = |at: usize| forces_n.get(contacts[at]).map_or(0.0, |n| n - still_n[at]);
        let sensor_n = 0.5 * (moving(0) + moving(1));
        trace.push(outcome.time_s + time_s, [sensor_n, moving(2)]);
    };
    bench.relax(system, State::after(shot, outcome), &mut push)
}

/// Times in s and heights in N of the incident, the wall's and the reflected peak.
fn peaks(passages: &Passages) -> [(f64, f64); 3] {
    let nothing = (f64::NAN, f64::NAN);
    match passages.peaks() {
        Ok((incident, wall, reflected)) => [
            (incident.time_s, incident.value),
            (wall.time_s, wall.value),
            reflected.map_or(nothing, |peak| (peak.time_s, peak.value)),
        ],
        Err(_) => [nothing; 3],
    }
}

/// One shot of a series with its true and its measured values.
#[derive(Clone, Debug)]
pub struct MeasuredShot {
    /// Number in the series, from 0.
    pub number: u32,
    /// Programmed speed in m/s.
    pub programmed_m_s: f64,
    /// Speed in m/s by the photogate.
    pub measured_m_s: f64,
    /// True speed in m/s.
    pub speed_m_s: f64,
    /// What happened in the chain.
    pub shot: Shot,
    /// What the recorder stored.
    pub record: Record,
}

/// Runs a series and hands over every shot as it comes.
///
/// # Errors
/// A shot that can't be computed, or what `take` returns.
pub fn run_series(
    plan: &Plan,
    series: &Series,
    take: &mut dyn FnMut(MeasuredShot) -> Result<(), RigError>,
) -> Result<(), RigError> {
    let experiment = &plan.case(series).experiment;
    let mut random = RandomStream::new(plan.seed, series.number, Purpose::Assembly);
    let gaps_mm = 1e3 * experiment.campaign().laying.gap_scatter_m;
    let when = || format!("laying the chain with gaps of {gaps_mm} mm in the mean (`gap_scatter`)");
    let bench = Bench::assemble(experiment, &mut random);
    let mut run = SeriesRun {
        campaign: experiment.campaign(),
        sensor_bead: experiment.sensor_bead(),
        plan,
        series,
        bench: bench.map_err(|why| failed(series, when(), &why))?,
    };
    let shots = u32::try_from(run.campaign.shots).unwrap_or(u32::MAX);
    (0..shots).try_for_each(|number| take(run.repeat(number)?))
}

fn failed(series: &Series, when: String, why: &StudyError) -> RigError {
    RigError::Shot(format!("series {}, {when}: {why}", series.name))
}

/// A series under way.
struct SeriesRun<'a> {
    plan: &'a Plan,
    series: &'a Series,
    campaign: &'a Campaign,
    bench: Bench<'a>,
    sensor_bead: usize,
}

impl SeriesRun<'_> {
    fn random(&self, purpose: Purpose) -> RandomStream {
        RandomStream::new(self.plan.seed, self.series.number, purpose)
    }

    /// Taps, rest, shot.
    fn repeat(&mut self, number: u32) -> Result<MeasuredShot, RigError> {
        let mut random = self.random(Purpose::Shot(number));
        let Campaign { actuator, photogate, amplifier, recorder, .. } = self.campaign;
        // The shot's own draws first: they are the same after any number of taps.
        let speed_m_s = true_speed_m_s(actuator, self.series.programmed_m_s, &mut random);
        let misplaced_m = actuator.placing_m * random.normal();
        let gate = GateReading::new(photogate, speed_m_s, misplaced_m, &mut random);
        let window = Window::new(recorder, gate.time_s, &mut random);
        self.taps(number, &mut random)?;
        let mut trace = window.trace();
        let shot = shoot(&mut self.bench, self.sensor_bead, speed_m_s, &mut trace);
        let shot = shot.map_err(|why| failed(self.series, format!("shot {}", number + 1), &why))?;
        let mut noise = self.random(Purpose::Noise(number));
        Ok(MeasuredShot {
            number,
            programmed_m_s: self.series.programmed_m_s,
            measured_m_s: gate.speed_m_s,
            speed_m_s,
            shot,
            record: window.record(trace, amplifier, recorder, &mut noise),
        })
    }

    fn taps(&mut self, number: u32, random: &mut RandomStream) -> Result<(), RigError> {
        let actuator = &self.campaign.actuator;
        let shot = number + 1;
        let tap_m_s = programmed(actuator, self.campaign.tap_speed_m_s).map_err(|why| {
            let series = &self.series.name;
            RigError::Speed(format!("taps before shot {shot} of series {series}: {why}"))
        })?;
        for tap in 1..=self.campaign.taps {
            if stopped() {
                return Err(RigError::Stopped);
            }
            let speed_m_s = true_speed_m_s(actuator, tap_m_s, random);
            let when = || format!("tap {tap} before shot {shot}");
            let rest = self.bench.tap(speed_m_s);
            rest.map_err(|why| failed(self.series, when(), &why))?;
        }
        Ok(())
    }
}

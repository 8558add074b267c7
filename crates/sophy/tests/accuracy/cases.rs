//! The examples with what is known of their solutions: data of `tests/reference`, or closed forms.

use crate::accuracy::models::{NANOAMPERE, STIFF_PAIR, UNDAMPED};
use sophy::{Experiment, FileWorld, Loaded, MemoryWorld, Model, load_experiment, load_model};
use sophy_testkit::{Reference, repository, stiff};
use std::path::Path;

/// A model, its experiment without any quanta, and its solution.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) model: Model,
    pub(crate) experiment: Experiment,
    /// Each state that is compared, with its values at `times`.
    pub(crate) states: Vec<(String, Vec<f64>)>,
    pub(crate) times: Vec<f64>,
    /// When transitions are taken.
    pub(crate) events: Vec<f64>,
    /// Whose transitions these are; empty for those of all.
    pub(crate) component: &'static str,
    /// Whether a run takes long.
    pub(crate) heavy: bool,
}

impl Case {
    fn example(name: &'static str, experiment: &str, stop: f64) -> Case {
        let loaded = load_experiment(&FileWorld, &repository().join("examples").join(experiment));
        Case::new(name, loaded, stop)
    }

    fn written(name: &'static str, text: &str, stop: f64) -> Case {
        let world = MemoryWorld::default().with("model.hsml", text);
        Case::new(name, load_model(&world, Path::new("model.hsml")), stop)
    }

    fn new(name: &'static str, loaded: Loaded, stop: f64) -> Case {
        let messages = loaded.messages();
        assert!(messages.is_empty(), "{name}: {messages:?}");
        // Few rows: what is compared is the trajectory.
        let every = Some(stop);
        Case {
            name,
            model: loaded.model.expect("a model"),
            experiment: Experiment { stop, every, quanta: Vec::new(), ..loaded.setup.experiment },
            states: Vec::new(),
            times: Vec::new(),
            events: Vec::new(),
            component: "",
            heavy: false,
        }
    }

    /// States and the columns of a file of `tests/reference` with their values.
    fn states<'a>(mut self, file: &str, columns: impl IntoIterator<Item = (&'a str, &'a str)>) -> Case {
        let reference = Reference::read(file);
        let columns = columns.into_iter();
        self.states = columns.map(|(state, column)| (state.to_owned(), reference.numbers(column))).collect();
        self.times = reference.numbers("t");
        self.times.retain(|&t| t <= self.experiment.stop);
        self
    }

    /// Transitions of a component (of all, if empty), in a file of `tests/reference`.
    fn events(mut self, component: &'static str, file: &str) -> Case {
        self.component = component;
        self.events = Reference::read(file).numbers("t");
        self.events.retain(|&t| t <= self.experiment.stop);
        self
    }

    fn solution<const N: usize>(mut self, step: f64, names: [&str; N], at: impl Fn(f64) -> [f64; N]) -> Case {
        let count = (self.experiment.stop / step).round() as usize;
        self.times = (0..=count).map(|k| k as f64 * step).collect();
        let rows: Vec<[f64; N]> = self.times.iter().map(|&t| at(t)).collect();
        let column = |(k, name): (usize, &str)| (name.to_owned(), rows.iter().map(|row| row[k]).collect());
        self.states = names.into_iter().enumerate().map(column).collect();
        self
    }

    fn heavy(self) -> Case {
        Case { heavy: true, ..self }
    }
}

/// All cases, in the order of the table.
pub(crate) fn cases() -> Vec<Case> {
    vec![
        Case::example("oscillator", "oscillator/oscillator.toml", 200.0)
            .states("oscillator/reference.csv", [("x1", "x1"), ("x2", "x2")]),
        Case::written("oscillator without damping", UNDAMPED, 100.0)
            .solution(0.1, ["x", "v"], |t| [libm::cos(t), -libm::sin(t)]),
        Case::example("two-timescale", "two-timescale/two-timescale.toml", 20.0)
            .states("two-timescale/reference.csv", [("x1", "x1"), ("x2", "x2")]),
        Case::written("stiff pair", STIFF_PAIR, 500.0).solution(0.5, ["x1", "x2"], stiff::stiff_pair_at),
        Case::written("nanoampere", NANOAMPERE, 5.0).solution(0.01, ["i", "u"], |t| {
            let rest = 1.0 - libm::exp(-t);
            [1e-9 * rest, 5.0 * (t - rest)]
        }),
        bouncing_ball(),
        Case::example("hopper", "hopper/hopper.toml", 20.0)
            .states("hopper/tau40_states.csv", HOPPER)
            .events("", "hopper/tau40_events.csv"),
        Case::example("hopper, half the thrust", "hopper/tau20.toml", 20.0)
            .states("hopper/tau20_states.csv", HOPPER)
            .events("", "hopper/tau20_events.csv"),
        Case::example("battery", "battery/battery.toml", 6000.0)
            .states("power-system/text_states.csv", [("Capacity", "C_Ah")])
            .events("", "power-system/text_events.csv"),
        Case::example("missile", "missile-roll/analog.toml", 1.0)
            .states("missile-roll/analog_states.csv", MISSILE)
            .events("relay", "missile-roll/analog_events.csv"),
        Case::example("underwater vehicle", "auv/open-loop.toml", 100.0)
            .states("auv-open-loop/slow_turn.csv", VEHICLE)
            .heavy(),
        Case::example("probe, a turn", "deep-space-probe/sliding-mode.toml", 60.0)
            .states("sliding-mode/set3_tuned.csv", PROBE)
            .heavy(),
        Case::example("probe, scanning", "deep-space-probe/scanning.toml", 60.0)
            .states("scanning/states.csv", PROBE)
            .events("", "scanning/events.csv")
            .heavy(),
        hovercraft("hovercraft, 5 s", 5.0),
        hovercraft("hovercraft, 20 s", 20.0),
    ]
}

const HOPPER: [(&str, &str); 4] = [("Position", "y"), ("Speed", "ydot"), ("Time", "timer"), ("ETA2", "eta2")];

const MISSILE: [(&str, &str); 4] =
    [("amplifier.e", "e_lb"), ("jet.F", "f_lb"), ("airframe.phi", "phi_rad"), ("airframe.p", "omega_rad_s")];

const VEHICLE: [(&str, &str); 12] = [
    ("vehicle.v[1]", "u"),
    ("vehicle.v[2]", "v"),
    ("vehicle.v[3]", "w"),
    ("vehicle.omega[1]", "p"),
    ("vehicle.omega[2]", "q"),
    ("vehicle.omega[3]", "r"),
    ("vehicle.position[1]", "x"),
    ("vehicle.position[2]", "y"),
    ("vehicle.position[3]", "z"),
    ("vehicle.theta[1]", "phi"),
    ("vehicle.theta[2]", "theta"),
    ("vehicle.theta[3]", "psi"),
];

const PROBE: [(&str, &str); 6] = [
    ("probe.theta[1]", "theta1"),
    ("probe.theta[2]", "theta2"),
    ("probe.theta[3]", "theta3"),
    ("probe.omega[1]", "w1"),
    ("probe.omega[2]", "w2"),
    ("probe.omega[3]", "w3"),
];

/// Impact k + 1 comes 2vₖ/g after impact k, which it leaves with vₖ = 0.8ᵏ√(2g); the 38th is the last.
fn bouncing_ball() -> Case {
    let g = 9.81;
    let (mut impacts, mut speeds) = (vec![f64::sqrt(2.0 / g)], vec![0.8 * f64::sqrt(2.0 * g)]);
    for k in 0..37 {
        impacts.push(impacts[k] + 2.0 * speeds[k] / g);
        speeds.push(0.8 * speeds[k]);
    }
    let at = |t: f64| match impacts.partition_point(|&impact| impact <= t) {
        0 => [1.0 - 0.5 * g * t * t, -g * t],
        38 => [0.0, 0.0],
        k => {
            let (s, v) = (t - impacts[k - 1], speeds[k - 1]);
            [v * s - 0.5 * g * s * s, v - g * s]
        }
    };
    let case = Case::example("bouncing ball", "bouncing-ball/bouncing-ball.toml", 5.0);
    Case { events: impacts.clone(), ..case.solution(0.02, ["y", "v"], at) }
}

fn hovercraft(name: &'static str, stop: f64) -> Case {
    let of_one = |i: usize| {
        let craft = [("p[1]", "x"), ("p[2]", "y"), ("v[1]", "vx"), ("v[2]", "vy")]
            .map(|(state, column)| (format!("craft[{i}].{state}"), format!("{column}{i}")));
        craft.into_iter().chain([(format!("pilot[{i}].q"), format!("q{i}"))])
    };
    let columns: Vec<(String, String)> = (1..=5).flat_map(of_one).collect();
    Case::example(name, "hovercraft/hovercraft.toml", stop)
        .states(
            "hovercraft/states.csv",
            columns.iter().map(|(state, column)| (state.as_str(), column.as_str())),
        )
        .events("", "hovercraft/events.csv")
        .heavy()
}

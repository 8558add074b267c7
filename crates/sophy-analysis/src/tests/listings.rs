//! The two systems that the literature prints, with their mistakes.

use crate::testing::{check, check_model};
use sophy_ir::Trigger;

/// Thesis A.6; `COMPRESSION_GUARD` and `FOOT` are where it is wrong.
const HOPPER: &str = "system RaibertsHopper
    constant G = 9.82
    constant Tp = 0.35
    constant L = 0.5
    constant GAMMA = 0.1
    constant TAU = 40
    constant ETA = 8
    state Position
    state Speed
    state Time
    state ETA2
    output Position
    output Speed
    location Flight
      der Position = Speed
      der Speed = -G
      der Time = 0
      der ETA2 = 0
      out Position = Position
      out Speed = Speed
      transition Ground Impact when Position < L goto Compression
    location Compression
      der Position = Speed
      der Speed = ETA/Position-GAMMA*Speed-G
      der Time = 0
      der ETA2 = 0
      out Position = Position
      out Speed = Speed
      transition Deaccelerated when COMPRESSION_GUARD goto Thrust
        reset Time = 0
    location Thrust
      der Position = Speed
      der Speed = TAU-GAMMA*Position-G
      der Time = 1
      der ETA2 = 0
      out Position = Position
      out Speed = Speed
      transition Thrust timer expires when (Time > Tp) || (Position > L) goto Decompression
        reset ETA2 = Position*TAU
    location Decompression
      der Position = Speed
      der Speed = ETA2/Position-GAMMA*Speed-G
      der Time = 0
      out Position = Position
      out Speed = Speed
      transition Ground Cleared when Position > FOOT goto Flight";

#[test]
fn every_mistake_of_the_printed_hopper_has_its_message() {
    check(
        &HOPPER.replace("COMPRESSION_GUARD", "Speed < 0").replace("FOOT", "FootHeight"),
        "warning[HS0402] line 29 `Speed < 0`: `Deaccelerated` is taken the instant location `Compression` is entered
           line 21 `Position < L`: the location is entered here: the rate of this quantity already has the sign \
         that is waited for
           help: did you mean `Speed > 0`?
         warning[HS0110] line 40 `Decompression`: state `ETA2` has no equation in location `Decompression`
           line 11 `ETA2`: declared here
           note: it keeps its value while the system is in this location
           help: if that is meant, say so: `der(ETA2) = 0`
         error[HS0101] line 46 `FootHeight`: `FootHeight` is not declared
           help: declare it, or use one of the names that exist: `Position`, `Speed`, `Time`, `ETA2`, `G`, `Tp`, \
         `L`, `GAMMA`, `TAU`, `ETA`, `pi`, `time`",
    );
}

#[test]
fn the_corrected_hopper_is_a_model() {
    let text = HOPPER
        .replace("COMPRESSION_GUARD", "Speed > 0")
        .replace("FOOT", "L")
        .replace("      der Time = 0\n      out Position = Position\n      out Speed = Speed\n      transition Ground Cl",
                 "      der Time = 0\n      der ETA2 = 0\n      out Position = Position\n      out Speed = Speed\n      transition Ground Cl");
    let model = check_model(&text, "");
    assert_eq!(model.name(), "RaibertsHopper");
    let names: Vec<&str> = model.root().variables.iter().map(|variable| variable.name.as_str()).collect();
    let states = ["Position", "Speed", "Time", "ETA2"];
    let outputs = ["Position", "Speed"];
    let constants = ["G", "Tp", "L", "GAMMA", "TAU", "ETA"];
    assert_eq!(names, [&constants[..], &states[..], &outputs[..]].concat());
    let component = crate::testing::automaton(&model);
    assert_eq!(component.initial_location, 0);
    let destinations: Vec<usize> = component
        .locations
        .iter()
        .flat_map(|location| &location.transitions)
        .map(|t| t.destination)
        .collect();
    assert_eq!(destinations, [1, 2, 3, 0]);
    assert!(matches!(component.locations[2].transitions[0].trigger, Trigger::When(_)));
    assert_eq!(component.locations[2].transitions[0].actions.assignments.len(), 1);
}

#[test]
fn every_mistake_of_the_printed_battery_has_its_message() {
    // Appendix A of the paper. The unbalanced parentheses are mistakes of grammar, which the reader reports.
    check(
        "system Battery
         constant HFull = 0.68
         constant LFull = 0.62
         constant HCritical = 0.4
         constant LCritical = 0.2
         state Capacity
         state ChargeMode
         input Pin
         output V
         location Nominal
           der M = 0
           der C = (0.00027*(Mode*Pin-20))/V
           out V = 18+10.6*C
           transition toPayload when C > HFull) goto Payload
             reset M = 0
           transition toSafe when C < LCritical) goto Safe
         location Payload
           der M = 0
           der C = (0.00027*(Mode*Pin-100))/V
           out V = 18+10.6*C
           transition toNominal when C < LFull) goto Charge
             reset M = 1
         location Safe
           der M = 0
           der C = (0.00027*(Mode*Pin-20))/V
           out V = 18+10.6*C
           transition toNominal when C > HCritical) goto Nominal",
        "error[HS0102] line 11 `M`: `M` has an equation, but is not declared as a state
           line 18 `M`: also here
           line 24 `M`: also here
           help: did you mean `ChargeMode`?
         error[HS0102] line 12 `C`: `C` has an equation, but is not declared as a state
           line 19 `C`: also here
           line 25 `C`: also here
           help: did you mean `Capacity`?
         error[HS0101] line 12 `Mode`: `Mode` is not declared
           line 19 `Mode`: also here
           line 25 `Mode`: also here
           help: did you mean `ChargeMode`?
         error[HS0101] line 13 `C`: `C` is not declared
           line 14 `C`: also here
           line 16 `C`: also here
           line 20 `C`: also here
           note: and 3 more places
           help: did you mean `Capacity`?
         error[HS0103] line 15 `M`: `M` is reset, but is not declared as a state
           line 22 `M`: also here
           help: did you mean `ChargeMode`?
         error[HS0114] line 21 `Charge`: there is no location `Charge`
           help: declare it, or use one of the locations: `Nominal`, `Payload`, `Safe`",
    );
}

#[test]
fn a_transition_with_guard_and_events_becomes_two() {
    let model = check_model(
        "state x
         location A
           der x = 1
           transition both when x > 1 goto B
             on b
             on a
             emit done
           transition event when false goto B
             on c
         location B
           der x = 0",
        "",
    );
    let component = crate::testing::automaton(&model);
    let labels =
        |ports: &[sophy_ir::EventPort]| -> Vec<String> { ports.iter().map(|p| p.name.to_string()).collect() };
    assert_eq!(labels(&model.root().input_events), ["a", "b", "c"]);
    assert_eq!(labels(&model.root().output_events), ["done"]);
    let shown: Vec<String> = component.locations[0]
        .transitions
        .iter()
        .map(|t| match &t.trigger {
            Trigger::When(_) => format!("{} when", t.name),
            Trigger::On { events, guard } => {
                format!("{} on {} {}", t.name, events.join(","), guard.is_some())
            }
            other => panic!("{other:?} in SOPHY XML"),
        })
        .collect();
    assert_eq!(shown, ["both when", "both on b,a false", "event on c false"]);
}

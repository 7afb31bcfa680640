//! Joints that follow others: what such couplings must satisfy, and what they do to starts and limits.

use crate::robot::{Coupling, Joint, Robot};

/// The first coupling that cannot be, and why: its joint follows two others, or itself over others or at once.
pub fn impossible(couplings: &[Coupling], joints: &[Joint]) -> Option<(usize, String)> {
    let mut leaders = vec![None; joints.len()];
    for (index, coupling) in couplings.iter().enumerate() {
        let name = &joints[coupling.follower].name;
        if leaders[coupling.follower].is_some() {
            return Some((index, format!("joint `{name}` follows two others: leave one of the two out")));
        }
        leaders[coupling.follower] = Some(coupling.leader);
        let mut above = std::iter::successors(Some(coupling.leader), |&joint| leaders[joint]);
        if above.any(|joint| joint == coupling.follower) {
            return Some((
                index,
                format!("joint `{name}` follows itself: let it follow a joint that moves on its own"),
            ));
        }
    }
    None
}

/// Gives each follower its start, and its leader the limits that the follower would reach: two stops that hold one
/// motion at once would share their force in no way that is known.
pub fn settle(robot: &mut Robot) {
    let mut leaders = vec![None; robot.joints.len()];
    for coupling in &robot.couplings {
        leaders[coupling.follower] = Some(coupling.leader);
    }
    let depth = |coupling: &Coupling| std::iter::successors(Some(coupling.leader), |&joint| leaders[joint]).count();
    // Leaders before their followers.
    let mut ordered = robot.couplings.clone();
    ordered.sort_by_key(depth);
    for coupling in ordered.iter().rev() {
        share_limits(robot, coupling);
    }
    robot.couplings = ordered;
}

/// Limits of a follower as those of its leader.
fn share_limits(robot: &mut Robot, coupling: &Coupling) {
    let follower = &robot.joints[coupling.follower];
    let Some((least, most)) = follower.limits else { return };
    let ratio = coupling.polynomial[1];
    if !coupling.is_linear() || ratio == 0.0 {
        let (name, leader) = (&follower.name, &robot.joints[coupling.leader].name);
        robot.notes.push(format!("The limits of joint `{name}` are left out: it follows `{leader}`."));
        robot.joints[coupling.follower].limits = None;
        return;
    }
    let ends = [least, most].map(|end| (end - coupling.polynomial[0]) / ratio);
    let (least, most) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let own = robot.joints[coupling.leader].limits.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let both = (own.0.max(least), own.1.min(most));
    let leader = &robot.joints[coupling.leader].name;
    let name = &robot.joints[coupling.follower].name;
    if both.0 < both.1 {
        robot.remarks.push(format!("The limits of joint `{name}` are among those of `{leader}`, which it follows."));
        robot.joints[coupling.leader].limits = Some(both);
    } else {
        robot
            .notes
            .push(format!("The limits of joint `{name}` are left out: with those of `{leader}` nothing could move."));
    }
    robot.joints[coupling.follower].limits = None;
}

/// The starts of followers, from those of their leaders.
pub fn start(robot: &mut Robot) {
    for coupling in &robot.couplings {
        robot.joints[coupling.follower].start = coupling.at(robot.joints[coupling.leader].start);
    }
}

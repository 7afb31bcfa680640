//! MJCF to a robot: bodies, joints, inertias, and what closes loops.
//!
//! Bodies are nested; a body's `pos` and orientation are its frame in the parent, a joint's `pos` and `axis` are in the
//! body's frame. Of several joints of a body the first is the outermost; between two stands a link without mass. Where
//! a body has no
//! `inertial`, its shapes give its mass. Source: MuJoCo's XML reference, 4.0.

mod actuators;
mod attach;
mod compiler;
mod contents;
mod defaults;
mod equality;
mod expand;
mod fitted;
mod fluid;
mod meshes;
mod moved;
mod orientation;
mod references;
mod rules;
mod scope;
mod settings;
mod shapes;
mod spring;
mod tendons;

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use crate::robot::{Inertia, Joint, JointKind, Law, Length, Link, Pose, Robot, Spring};
use crate::xml::{Node, unread};
use crate::{Folder, ImportError, Options};
use compiler::FromShapes;
use contents::{Item, contents};
use defaults::Element;
use expand::Model;
use fluid::Fluid;
use scope::Scopes;
use settings::Settings;

/// Reads a robot; `folder` has the files that it includes.
///
/// # Errors
/// What is no MJCF, or has values that cannot be.
pub fn read(text: &str, folder: Folder, options: Options) -> Result<Robot, ImportError> {
    let root = Node::parse(text, None)?;
    if root.name != "mujoco" {
        let action = "give an MJCF file, or use `urdf` for a URDF";
        return Err(ImportError::WrongRoot { found: root.name, wanted: "mujoco", action });
    }
    let expanded = expand::expand(root, folder)?;
    let (root, attached) = expanded.split();
    let mut reader = Reader::new(&expanded.models, options)?;
    reader.robot.notes.extend(expanded.notes.iter().cloned());
    root.needed_child("worldbody")?;
    for world in root.children("worldbody") {
        reader.world(world)?;
    }
    if let Some(total) = reader.scopes.of(root).compiler.total {
        reader.scale(total);
    }
    reader.damp_springs();
    actuators::load_joints(&mut reader, root)?;
    tendons::read(&mut reader, root)?;
    reader.armatures_of_free_joints();
    equality::read(&mut reader, root)?;
    if options.actuators && reader.settings.actuators {
        actuators::read(&mut reader, root)?;
    }
    reader.left_out(root);
    for model in attached {
        model.mark_what_does_not_count();
    }
    let unread: Vec<_> = expanded.models.iter().flat_map(|model| unread(&model.root)).collect();
    reader.robot.notes.extend(crate::unread::notes(&unread, rules::RULES));
    Ok(reader.robot)
}

struct Reader<'n> {
    scopes: Scopes<'n>,
    settings: Settings,
    fluid: Option<Fluid>,
    options: Options,
    bodies: BTreeMap<String, usize>,
    /// The joints that the file names.
    joints: BTreeMap<String, usize>,
    /// The tendons that the file names, and the length of each; none where it is no sum of joints.
    tendons: BTreeMap<String, Option<Length>>,
    /// The frame of each body in the ground, with all joints at 0.
    places: Vec<Pose>,
    /// Time constant and damping ratio of joints that have their springs so.
    spring_dampers: Vec<(usize, [f64; 2])>,
    /// What MuJoCo counts from, of joints where that is not 0.
    references: BTreeMap<usize, f64>,
    /// The range of each joint that has one, whether it is kept or not, from where the joint is at 0.
    ranges: BTreeMap<usize, (f64, f64)>,
    /// Whether a shape could touch another one.
    has_shapes: bool,
    robot: Robot,
}

impl<'n> Reader<'n> {
    fn new(models: &'n [Model], options: Options) -> Result<Self, ImportError> {
        let root = &models[0].root;
        let settings = Settings::new(root)?;
        let name = root.attribute("model").unwrap_or("robot");
        Ok(Self {
            scopes: Scopes::new(models)?,
            fluid: Fluid::new(root)?.filter(|_| settings.springs || settings.dampers),
            options,
            bodies: BTreeMap::from([("world".to_owned(), 0)]),
            joints: BTreeMap::new(),
            tendons: BTreeMap::new(),
            places: vec![Pose::identity()],
            spring_dampers: Vec::new(),
            references: BTreeMap::new(),
            ranges: BTreeMap::new(),
            has_shapes: false,
            robot: Robot { gravity: settings.gravity, ..Robot::new(name, "MJCF") },
            settings,
        })
    }

    fn world(&mut self, node: &'n Node) -> Result<(), ImportError> {
        let world = Item { node, frame: Pose::identity(), class: node.attribute("childclass"), ending: String::new() };
        node.mark("name");
        let items = contents(&world, &self.scopes)?;
        self.sum_of_shapes(&items)?;
        // A body before what it carries, without a call for each level.
        let inner = |items: Vec<Item<'n>>, parent: usize| {
            items.into_iter().filter(|item| item.node.name == "body").rev().map(move |item| (item, parent))
        };
        let mut left: Vec<(Item, usize)> = inner(items, 0).collect();
        while let Some((item, parent)) = left.pop() {
            let (link, items) = self.body(&item, parent)?;
            left.extend(inner(items, link));
        }
        Ok(())
    }

    /// A body and its joints; its link and what is inside.
    fn body(&mut self, item: &Item<'n>, parent: usize) -> Result<(usize, Vec<Item<'n>>), ImportError> {
        let node = item.node;
        let class = self.scopes.class_inside(node, item.class)?;
        let pose = item.frame.then(&self.scopes.pose(&Element::plain(node))?);
        let inside = Item { frame: Pose::identity(), class, ..item.clone() };
        let items = contents(&inside, &self.scopes)?;
        let (inertia, axes) = self.inertia(node, &items)?;
        let joints: Vec<&Item> = items.iter().filter(|item| item.node.name.ends_with("joint")).collect();
        self.refuse_joints(node, &joints, parent)?;
        let count = self.robot.links.len();
        let name = item.name().unwrap_or_else(|| format!("body{count}"));
        let absolute = self.places[parent].then(&pose);
        let (mut from, mut frame) = (parent, pose);
        for (k, joint) in joints.iter().enumerate() {
            let to = if k + 1 == joints.len() { name.clone() } else { format!("{name}_carrier{}", k + 1) };
            let to = self.link(&to, absolute);
            self.joint(joint, &format!("{name}_joint{}", k + 1), (from, to), frame)?;
            (from, frame) = (to, Pose::identity());
        }
        if joints.is_empty() {
            from = self.link(&name, absolute);
            self.robot.joints.push(Joint::new(&format!("{name}_mount"), JointKind::Fixed, (parent, from), pose));
        }
        self.robot.links[from].inertia = inertia;
        self.lift(node, from)?;
        self.drag(&items, from, axes)?;
        if let Some(name) = item.name()
            && self.bodies.insert(name.clone(), from).is_some()
        {
            return Err(ImportError::Twice { place: node.place.clone(), what: "body", name });
        }
        Ok((from, items))
    }

    /// What no body can have.
    fn refuse_joints(&self, body: &Node, joints: &[&Item<'n>], parent: usize) -> Result<(), ImportError> {
        let mut kinds = Vec::new();
        for joint in joints {
            kinds.push(self.kind(joint)?);
        }
        let wrong = |what: &str| Err(ImportError::Wrong { place: body.place.clone(), what: what.to_owned() });
        let is_free = kinds.contains(&JointKind::Free);
        if is_free && kinds.len() > 1 {
            return wrong("a body with a free joint has no other joint: leave one out");
        }
        if is_free && parent != 0 {
            return wrong("a free joint is for bodies of <worldbody> only: move the body there");
        }
        let turns = |kind: &JointKind| matches!(kind, JointKind::Spherical | JointKind::Revolute);
        let after_ball = kinds.iter().skip_while(|kind| **kind != JointKind::Spherical).skip(1);
        if after_ball.clone().any(turns) {
            return wrong("a body with a ball joint turns about nothing else after it: leave a joint out");
        }
        let freedoms: usize = kinds.iter().map(|kind| if *kind == JointKind::Spherical { 3 } else { 1 }).sum();
        if freedoms > 6 {
            return wrong("a body moves in at most 6 ways: leave a joint out");
        }
        Ok(())
    }

    /// What a fluid does to a body.
    fn drag(&mut self, items: &[Item<'n>], link: usize, axes: Option<Matrix3<f64>>) -> Result<(), ImportError> {
        let Some(fluid) = &self.fluid else { return Ok(()) };
        let link = &mut self.robot.links[link];
        let Some(inertia) = link.inertia.filter(|inertia| inertia.mass > 0.0) else { return Ok(()) };
        for item in items.iter().filter(|item| item.node.name == "geom") {
            if self.scopes.element(item.node, item.class)?.text("fluidshape") == Some("ellipsoid") {
                let what = "the fluid around its ellipsoids (fluidshape) does not act on it";
                self.robot.notes.push(format!("{}: body `{}`: {what}.", item.node.place, link.name));
                return Ok(());
            }
        }
        let (principal, is_unique) = fluid::principal(&inertia);
        if axes.is_none() && !is_unique {
            let what = "brakes along axes that MuJoCo may choose otherwise, since two of its moments are equal";
            self.robot.notes.push(format!("The fluid around body `{}` {what}.", link.name));
        }
        link.drags.push(fluid.drag(&inertia, axes.unwrap_or(principal)));
        self.robot.wind = fluid.wind;
        Ok(())
    }

    /// The weight that does not act on a body.
    fn lift(&mut self, node: &Node, link: usize) -> Result<(), ImportError> {
        let part = node.number("gravcomp")?.unwrap_or(0.0);
        let acts = self.settings.springs || self.settings.dampers;
        let link = &mut self.robot.links[link];
        if let Some(inertia) = link.inertia.filter(|inertia| acts && part != 0.0 && inertia.mass > 0.0) {
            link.lifts.push((part * inertia.mass, inertia.center));
        }
        Ok(())
    }

    fn link(&mut self, name: &str, place: Pose) -> usize {
        self.robot.links.push(Link::new(name));
        self.places.push(place);
        self.robot.links.len() - 1
    }

    /// Which motion a joint leaves.
    fn kind(&self, item: &Item<'n>) -> Result<JointKind, ImportError> {
        if item.node.name == "freejoint" {
            return Ok(JointKind::Free);
        }
        let element = self.scopes.element(item.node, item.class)?;
        match element.text("type").unwrap_or("hinge") {
            "free" => Ok(JointKind::Free),
            "ball" => Ok(JointKind::Spherical),
            "slide" => Ok(JointKind::Prismatic),
            "hinge" => Ok(JointKind::Revolute),
            other => Err(item.node.bad("type", other, "free, ball, slide or hinge")),
        }
    }

    /// A joint at a frame of the parent that is the child's frame.
    fn joint(&mut self, item: &Item<'n>, unnamed: &str, ends: (usize, usize), frame: Pose) -> Result<(), ImportError> {
        let given = item.name();
        let name = given.as_deref().unwrap_or(unnamed);
        if let Some(name) = &given
            && self.joints.insert(name.clone(), self.robot.joints.len()).is_some()
        {
            return Err(ImportError::Twice { place: item.node.place.clone(), what: "joint", name: name.clone() });
        }
        let kind = self.kind(item)?;
        if item.node.name == "freejoint" {
            self.robot.joints.push(Joint::new(name, kind, ends, frame));
            return Ok(());
        }
        let element = self.scopes.element(item.node, item.class)?;
        let place = if kind == JointKind::Free { Vector3::zeros() } else { element.vector("pos")?.unwrap_or_default() };
        let anchor = Pose::at(if kind == JointKind::Free { place } else { item.frame.then(&Pose::at(place)).place });
        let mut joint = Joint { in_child: anchor, ..Joint::new(name, kind, ends, frame.then(&anchor)) };
        if self.settings.dampers {
            joint.damping = Law(element.up_to("damping")?);
        } else {
            item.node.mark("damping");
        }
        if joint.is_scalar() {
            self.scalar_joint(&element, &mut joint, item)?;
        } else {
            self.turning_joint(&element, &mut joint)?;
        }
        self.robot.joints.push(joint);
        Ok(())
    }

    /// What a free and a ball joint have.
    fn turning_joint(&mut self, element: &Element<'n>, joint: &mut Joint) -> Result<(), ImportError> {
        if joint.kind == JointKind::Free {
            joint.armature = element.not_negative("armature")?;
        }
        if joint.damping.0[0] < 0.0 {
            return Err(element.node.bad("damping", element.text("damping").unwrap_or_default(), "0 or more"));
        }
        if !joint.damping.is_linear() {
            self.robot.notes.push(format!(
                "Joint `{}` brakes in proportion to its speed: the other coefficients of its damping are left out.",
                joint.name
            ));
        }
        if !self.settings.friction {
            element.node.mark("frictionloss");
        }
        if !self.settings.limits {
            element.node.mark("range");
        }
        if !self.settings.springs {
            element.node.mark("stiffness");
        }
        Ok(())
    }

    /// The armature of a free joint resists the velocity of the origin and the angular velocity alike: a ball there,
    /// without a weight.
    fn armatures_of_free_joints(&mut self) {
        let free = self.robot.joints.iter_mut().filter(|joint| joint.kind == JointKind::Free && joint.armature > 0.0);
        for joint in free {
            let (armature, link) = (std::mem::take(&mut joint.armature), &mut self.robot.links[joint.child]);
            let ball = Inertia { mass: armature, center: Vector3::zeros(), tensor: armature * Matrix3::identity() };
            link.inertia = Some(link.inertia.map_or(ball, |own| own.with(&ball)));
            link.lifts.push((armature, Vector3::zeros()));
            self.robot.remarks.push(format!(
                "Mass and moments of `{}` have the armature {} of `{}` in them, whose weight does not act.",
                link.name,
                crate::number::number(armature),
                joint.name
            ));
        }
    }

    /// The index of a joint that an element names.
    fn joint_of(&self, node: &Node, name: &str) -> Result<usize, ImportError> {
        let unknown = || ImportError::Unknown { place: node.place.clone(), what: "joint", name: name.to_owned() };
        self.joints.get(name).copied().ok_or_else(unknown)
    }

    /// The sum of joints' values, as the file counts them, each times a factor.
    fn length(&self, parts: impl IntoIterator<Item = (usize, f64)>) -> Length {
        let parts: Vec<(usize, f64)> = parts.into_iter().collect();
        let shift = |part: &(usize, f64)| part.1 * self.references.get(&part.0).copied().unwrap_or(0.0);
        Length { constant: parts.iter().map(shift).sum(), parts }
    }

    fn scalar_joint(&mut self, element: &Element<'n>, joint: &mut Joint, item: &Item<'n>) -> Result<(), ImportError> {
        let name = joint.name.clone();
        let axis = element.vector("axis")?.unwrap_or(Vector3::z());
        let text = || format!("{} {} {}", axis.x, axis.y, axis.z);
        let bad = || element.node.bad("axis", &text(), "a direction, not zero");
        let size = axis.amax();
        let direction = if size > 1e-8 { (axis / size).normalize() } else { return Err(bad()) };
        joint.axis = item.frame.turned * direction;
        let unit =
            if joint.kind == JointKind::Revolute { self.scopes.of(element.node).compiler.angles.unit } else { 1.0 };
        let reference = element.number("ref")?.unwrap_or(0.0) * unit;
        let friction = element.not_negative("frictionloss")?;
        joint.friction = if self.settings.friction { friction } else { 0.0 };
        joint.armature = element.not_negative("armature")?;
        let rest = element.number("springref")?.unwrap_or(0.0) * unit - reference;
        let law = Law(element.up_to("stiffness")?);
        joint.spring = Some(Spring { law, rest }).filter(|spring| self.settings.springs && !spring.law.is_zero());
        let timed: [f64; 2] = element.up_to("springdamper")?;
        if timed[0] > 0.0 && timed[1] > 0.0 {
            joint.spring = Some(Spring { law: Law::default(), rest });
            self.spring_dampers.push((self.robot.joints.len(), timed));
        }
        let limits = self.limits(element, unit, reference)?;
        joint.limits = limits.filter(|_| self.settings.limits);
        self.ranges.extend(limits.map(|limits| (self.robot.joints.len(), limits)));
        if reference != 0.0 {
            self.references.insert(self.robot.joints.len(), reference);
            let shift = crate::number::number(reference);
            let remark = format!("Joint `{name}` counts from its start: MuJoCo's value is larger by {shift}.");
            self.robot.remarks.push(remark);
        }
        Ok(())
    }

    fn limits(&self, element: &Element, unit: f64, reference: f64) -> Result<Option<(f64, f64)>, ImportError> {
        let is_limited = element.truth("limited")?;
        if is_limited == Some(true) && element.text("range").is_none() {
            return Err(element.node.missing("range"));
        }
        let Some(text) = element
            .text("range")
            .filter(|_| is_limited.unwrap_or(self.scopes.of(element.node).compiler.automatic_limits))
        else {
            return Ok(None);
        };
        let [least, most] = ends_of_range(element.node, text)?;
        if is_limited == Some(true) && least >= most {
            return Err(element.node.bad("range", text, "two numbers, the smaller one first"));
        }
        let is_range = least < most && (least.is_finite() || most.is_finite());
        Ok(is_range.then_some((least * unit - reference, most * unit - reference)))
    }

    /// Of `inertial`, else of the shapes; none where there is neither. With the principal axes where the file says
    /// them.
    fn inertia(
        &mut self,
        body: &'n Node,
        items: &[Item<'n>],
    ) -> Result<(Option<Inertia>, Option<Matrix3<f64>>), ImportError> {
        let (from_shapes, axes_of_shape) = self.sum_of_shapes(items)?;
        let mut given = items.iter().filter(|item| item.node.name == "inertial");
        let first = given.next();
        if let Some(second) = given.next() {
            let what = "a second <inertial> of one body: leave one of the two out".to_owned();
            return Err(ImportError::Wrong { place: second.node.place.clone(), what });
        }
        let compiler = &self.scopes.of(body).compiler;
        let is_used = match compiler.from_shapes {
            FromShapes::Always => from_shapes.is_none(),
            FromShapes::Otherwise | FromShapes::Never => true,
        };
        let inertia = match first {
            Some(item) if is_used => self.given(item, items.iter().any(|item| item.node.name.ends_with("joint")))?,
            Some(item) => {
                item.node.mark_all();
                from_shapes
            }
            None if compiler.from_shapes == FromShapes::Never => None,
            None => from_shapes,
        };
        let axes = match first {
            Some(item) if is_used => {
                let is_full = item.node.peek("fullinertia").is_some();
                let own = self.scopes.pose(&Element::plain(item.node))?;
                Some(item.frame.turned * own.turned).filter(|_| !is_full)
            }
            _ => axes_of_shape,
        };
        Ok((compiler.bounded(inertia, first.map_or(body, |item| item.node))?, axes))
    }

    /// What `inertial` says; of a body that a joint moves also its moments.
    fn given(&self, item: &Item<'n>, is_moved: bool) -> Result<Option<Inertia>, ImportError> {
        let node = item.node;
        node.needed("mass")?;
        let mass = node.not_negative("mass")?;
        if let (Some(_), Some(_)) = (node.peek("fullinertia"), node.peek("diaginertia")) {
            let what = "<inertial> has `fullinertia` and `diaginertia`: leave one of the two out".to_owned();
            return Err(ImportError::Wrong { place: node.place.clone(), what });
        }
        let tensor = if let Some(text) = node.attribute("fullinertia") {
            let [xx, yy, zz, xy, xz, yz] = node.array::<6>("fullinertia", text)?;
            Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        } else if let (None, false) = (node.peek("diaginertia"), is_moved) {
            node.mark("diaginertia");
            Matrix3::zeros()
        } else {
            let text = node.needed("diaginertia")?;
            let moments = node.array::<3>("diaginertia", text)?;
            if moments.iter().any(|moment| *moment < 0.0) {
                return Err(node.bad("diaginertia", text, "0 or more"));
            }
            Matrix3::from_diagonal(&Vector3::from(moments))
        };
        let frame = item.frame.then(&self.scopes.pose(&Element::plain(node))?);
        let is_something = mass > 0.0 || tensor != Matrix3::zeros();
        Ok(is_something.then(|| Inertia { mass, center: Vector3::zeros(), tensor }.seen_from(&frame)))
    }

    /// All shapes of a body in one; all are looked at. With the axes of the shape, where one alone has a mass.
    fn sum_of_shapes(&mut self, items: &[Item<'n>]) -> Result<(Option<Inertia>, Option<Matrix3<f64>>), ImportError> {
        let mut sum: Option<Inertia> = None;
        let mut axes = Vec::new();
        for item in items.iter().filter(|item| item.node.name == "geom") {
            let element = self.scopes.element(item.node, item.class)?;
            let group = element.number("group")?.unwrap_or(0.0);
            let compiler = &self.scopes.of(item.node).compiler;
            let has_mass = group >= compiler.groups.0 && group <= compiler.groups.1;
            let kept = has_mass && compiler.from_shapes != FromShapes::Never;
            let shape = shapes::read(&element, &self.scopes, kept)?;
            self.robot.notes.extend(shape.note);
            self.has_shapes |=
                ["contype", "conaffinity"].iter().any(|name| element.text(name).map(str::trim) != Some("0"));
            if let Some(inertia) = shape.inertia.filter(|_| kept).map(|inertia| inertia.seen_from(&item.frame)) {
                sum = Some(sum.map_or(inertia, |sum| sum.with(&inertia)));
                axes.push(shape.axes.map(|axes| item.frame.turned * axes));
            }
        }
        Ok((sum, if let [axes] = axes[..] { axes } else { None }))
    }

    /// Scales masses and moments so that the masses' sum is the one given.
    fn scale(&mut self, total: f64) {
        let sum: f64 = self.robot.links.iter().filter_map(|link| link.inertia).map(|inertia| inertia.mass).sum();
        if sum <= 0.0 {
            return;
        }
        for link in &mut self.robot.links {
            if let Some(inertia) = &mut link.inertia {
                inertia.mass *= total / sum;
                inertia.tensor *= total / sum;
            }
            link.lifts.iter_mut().for_each(|lift| lift.0 *= total / sum);
        }
    }

    fn left_out(&mut self, root: &Node) {
        if !self.options.actuators {
            let sections: Vec<&Node> = root.children("actuator").collect();
            sections.iter().for_each(|section| section.mark_deep());
            if self.settings.actuators && sections.iter().any(|section| !section.children.is_empty()) {
                let what = "The actuators are left out; each joint has an input of its own. With --actuators those \
                            that act on joints are not.";
                self.robot.notes.push(what.to_owned());
            }
        }
        // Assets count where they are used.
        for asset in root.children("asset").flat_map(Node::all_children) {
            asset.mark_deep();
        }
        if self.has_shapes && self.settings.contacts && self.options.contacts {
            let what =
                "Shapes touch nothing: there is no contact with the floor (--no-contacts says that you know it).";
            self.robot.notes.push(what.to_owned());
        }
    }
}

/// Two numbers, which may be infinite.
fn ends_of_range(node: &Node, text: &str) -> Result<[f64; 2], ImportError> {
    let parse = |word: &str| word.parse().ok().filter(|value: &f64| !value.is_nan());
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(parse).collect();
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| node.bad("range", text, "2 numbers"))
}

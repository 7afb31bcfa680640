//! The machine in motion as binary glTF 2.0, for other programs.
//!
//! In: an animation. Out: the bytes of a `.glb` file: a node for each body, moved by one animation, with meshes of its
//! solids, and one that turns them so that they fall along -y.
//! Source: the glTF 2.0 specification of the Khronos Group (ISO/IEC 12113:2022), sections 3 and 4.4. Lengths in m, y
//! up, as glTF has it; times in s from the first sample.

use serde_json::{Value, json};

use super::animation::{Animation, BodyTrack};
use super::mesh::{Mesh, meshes};
use crate::show::figures::palette::CURVES;

/// Of a buffer view: vertices, indices.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Of an accessor.
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;

/// The file's bytes; `None` of an animation without bodies or samples.
#[must_use]
pub fn glb(animation: &Animation) -> Option<Vec<u8>> {
    if animation.bodies.is_empty() || animation.times.is_empty() {
        return None;
    }
    let mut buffer = Buffer::default();
    let first = animation.times[0];
    let times: Vec<[f32; 1]> = animation.times.iter().map(|t| [(t - first) as f32]).collect();
    let times = buffer.floats(&times, "SCALAR", None, true);
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut meshes_of_bodies = Vec::new();
    let mut nodes = Vec::new();
    for (index, body) in animation.bodies.iter().enumerate() {
        let primitives: Vec<Value> =
            meshes(body, animation.size()).iter().map(|mesh| buffer.mesh(mesh, index)).collect();
        let mut node =
            json!({ "name": body.name, "translation": body.position[0], "rotation": unit(body.orientation[0]) });
        if !primitives.is_empty() {
            node["mesh"] = meshes_of_bodies.len().into();
            meshes_of_bodies.push(json!({ "name": body.name, "primitives": primitives }));
        }
        nodes.push(node);
        for (path, output) in [("translation", positions(&mut buffer, body)), ("rotation", turns(&mut buffer, body))] {
            channels.push(json!({ "sampler": samplers.len(), "target": { "node": index, "path": path } }));
            samplers.push(json!({ "input": times, "output": output, "interpolation": "LINEAR" }));
        }
    }
    let bodies: Vec<usize> = (0..nodes.len()).collect();
    nodes.push(json!({ "name": "machine", "rotation": animation.upright(), "children": bodies }));
    let document = json!({
        "asset": { "version": "2.0", "generator": "bg-workbench" },
        "scene": 0,
        "scenes": [{ "nodes": [nodes.len() - 1] }],
        "nodes": nodes,
        "meshes": meshes_of_bodies,
        "materials": materials(animation.bodies.len()),
        "animations": [{ "name": "run", "channels": channels, "samplers": samplers }],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    Some(file(&document, buffer.bytes))
}

fn positions(buffer: &mut Buffer, body: &BodyTrack) -> usize {
    let places: Vec<[f32; 3]> = body.position.iter().map(|place| place.map(|x| x as f32)).collect();
    buffer.floats(&places, "VEC3", None, false)
}

fn turns(buffer: &mut Buffer, body: &BodyTrack) -> usize {
    let turns: Vec<[f32; 4]> = body.orientation.iter().map(|&turn| unit(turn).map(|x| x as f32)).collect();
    buffer.floats(&turns, "VEC4", None, false)
}

/// A quaternion of length one.
fn unit(quaternion: [f64; 4]) -> [f64; 4] {
    let length = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { quaternion.map(|x| x / length) } else { [0.0, 0.0, 0.0, 1.0] }
}

/// A material for each body, in the colours of the page.
fn materials(count: usize) -> Vec<Value> {
    let of = |index: usize| {
        let shade = CURVES[index % CURVES.len()].light;
        // Colours of glTF are linear, those of the page sRGB.
        let linear = |byte: u8| {
            let value = f64::from(byte) / 255.0;
            if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        let colour = [linear(shade.0), linear(shade.1), linear(shade.2), 1.0];
        json!({ "pbrMetallicRoughness": { "baseColorFactor": colour, "metallicFactor": 0.1, "roughnessFactor": 0.6 } })
    };
    (0..count).map(of).collect()
}

/// The binary part with its tables.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds rows of floats and gives their accessor; with their least and largest where these must be said.
    fn floats<const K: usize>(
        &mut self,
        rows: &[[f32; K]],
        kind: &str,
        target: Option<u32>,
        is_bounded: bool,
    ) -> usize {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let mut accessor = json!({ "componentType": FLOAT, "count": rows.len(), "type": kind });
        if is_bounded {
            let fold = |choose: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..K).map(|k| rows.iter().map(|row| row[k]).reduce(choose).unwrap_or(0.0)).collect()
            };
            accessor["min"] = fold(f32::min).into();
            accessor["max"] = fold(f32::max).into();
        }
        self.add(&bytes, target, accessor)
    }

    fn mesh(&mut self, mesh: &Mesh, material: usize) -> Value {
        let positions = self.floats(&mesh.positions, "VEC3", Some(ARRAY_BUFFER), true);
        let normals = self.floats(&mesh.normals, "VEC3", Some(ARRAY_BUFFER), false);
        let bytes: Vec<u8> = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let accessor = json!({ "componentType": UNSIGNED_SHORT, "count": mesh.indices.len(), "type": "SCALAR" });
        let indices = self.add(&bytes, Some(ELEMENT_ARRAY_BUFFER), accessor);
        json!({ "attributes": { "POSITION": positions, "NORMAL": normals }, "indices": indices, "material": material })
    }

    fn add(&mut self, bytes: &[u8], target: Option<u32>, mut accessor: Value) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        accessor["bufferView"] = self.views.len().into();
        self.views.push(view);
        self.accessors.push(accessor);
        self.bytes.extend(bytes);
        pad(&mut self.bytes, 0);
        self.accessors.len() - 1
    }
}

/// Fills up to a multiple of four bytes.
fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), with);
}

/// The header and the two chunks.
fn file(document: &Value, binary: Vec<u8>) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    pad(&mut text, b' ');
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let mut bytes = Vec::with_capacity(length);
    bytes.extend(b"glTF");
    for word in [2, length as u32, text.len() as u32] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(b"JSON");
    bytes.extend(text);
    bytes.extend((binary.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(binary);
    bytes
}

//! `hangpose inspect`.

use super::input::{self, Placed, Placement, TOO_LARGE, TOO_SMALL};
use super::json::{self, InspectedObject, InspectedSupporter};
use super::{InspectArguments, Role, terminal};
use anyhow::Result;
use hangpose::files::{self, MeshFile, SupporterFile};
use hangpose::geometry::{MassProperties, Symmetry, Vector};
use hangpose::hanging::{ObjectCounts, SupporterCounts};
use hangpose::{CentreOfMass, Monitor, analyze_object, analyze_supporter};
use std::process::ExitCode;
use std::time::Instant;

pub(crate) fn run(arguments: &InspectArguments) -> Result<ExitCode> {
    let path = &arguments.file;
    let text = match arguments.role {
        Some(Role::Object) => object(files::read_mesh(path)?, arguments)?,
        Some(Role::Supporter) => supporter(files::read_supporter(path)?, arguments)?,
        None => match files::read_supporter(path)? {
            SupporterFile::Mesh(mesh) => object(mesh, arguments)?,
            cloud => supporter(cloud, arguments)?,
        },
    };
    terminal::print(&text)?;
    Ok(ExitCode::SUCCESS)
}

fn placement(arguments: &InspectArguments) -> Placement {
    Placement { scale: arguments.scale, up: arguments.up, scale_option: Some("--scale") }
}

fn object(file: MeshFile, arguments: &InspectArguments) -> Result<String> {
    let params = arguments.method.params()?;
    let Placed { shape: file, scale_warning } = input::object(&arguments.file, file, &placement(arguments))?;
    let mesh = file.mesh()?;
    let start = Instant::now();
    let mut memory = Vec::new();
    let object = analyze_object(&mesh, &params, &mut memory, &Monitor::new())?;
    let seconds = start.elapsed().as_secs_f64();
    let inspected = InspectedObject {
        schema: json::SCHEMA,
        role: "object",
        vertices: mesh.vertices().len(),
        triangles: mesh.triangles().len(),
        extents: mesh.aabb().extents().into(),
        scale_warning,
        mass: *object.mass(),
        centre_of_mass: object.centre_of_mass().into(),
        symmetries: json::symmetries(&object),
        counts: object.counts().into(),
        sites: json::sites(object.sites()),
        contacts: object.contacts().collect(),
        seconds,
    };
    if arguments.json {
        return Ok(json::text(&inspected));
    }
    let mass = object.mass();
    let mut text = format!("object, {} triangles, {}\n", inspected.triangles, closedness(mass));
    text += &format!("size            {} mm\n", millimetres(&mesh.aabb().extents()));
    text += &scale(&inspected.scale_warning);
    text += &format!(
        "centre of mass  {} mm, {}\n",
        millimetres(&object.centre_of_mass().coords),
        match params.centre_of_mass {
            CentreOfMass::Given(_) => "given",
            CentreOfMass::Volume if mass.volume_centroid.is_some() && mass.is_closed =>
                "centroid of the volume",
            CentreOfMass::Volume if mass.volume_centroid.is_some() => {
                "centroid of the volume with its holes closed"
            }
            _ => "mean of the surface samples",
        }
    );
    text += &match mass.volume {
        Some(volume) => format!("volume          {:.1} cm3\n", volume * 1e6),
        // A triangle with the wrong winding leaves the surface open.
        None => "volume          none: the mesh is open, or some of its triangles face inwards\n".into(),
    };
    text += &format!("area            {:.1} cm2\n", mass.area * 1e4);
    for Symmetry { axis, fold } in object.symmetries() {
        let turns = if *fold == 0 { "any turn".into() } else { format!("turns by 1/{fold}") };
        text += &format!("symmetry        {turns} about {}\n", direction(axis));
    }
    text += &match object.counts() {
        ObjectCounts::Sites(counts) => format!(
            "contact points  {}, in {} clusters, {} with free space, {} encircled, {} different\n",
            counts.contact_points, counts.clusters, counts.with_free_space, counts.encircled, counts.sites
        ),
        ObjectCounts::Contacts(counts) => format!(
            "contact points  {}, {} of them contact candidates, the deepest capture first\n",
            counts.contact_points, counts.contacts
        ),
    };
    if object.contacts().len() > 0 {
        text += "index  position, mm               bar direction        capture depth, mm\n";
    }
    for (index, contact) in object.contacts().enumerate().take(SHOWN) {
        text += &format!(
            "{index:5}  {}  {}  {:15.1}\n",
            millimetres(&contact.position.coords),
            direction(&contact.bar_direction),
            contact.capture * 1000.0,
        );
    }
    if object.sites().len() > 0 {
        text += "site  position, mm               hanging direction      free space, mm  encircled  points\n";
    }
    for (index, site) in object.sites().enumerate() {
        text += &format!(
            "{index:4}  {}  {}  {:14.1}  {:9.2}  {:6}\n",
            millimetres(&site.position.coords),
            direction(&site.hanging_direction),
            site.free_space_radius * 1000.0,
            site.encircled,
            site.contact_points,
        );
    }
    Ok(text)
}

fn supporter(file: SupporterFile, arguments: &InspectArguments) -> Result<String> {
    let params = arguments.method.params()?;
    let (path, placement) = (&arguments.file, placement(arguments));
    let Placed { shape: file, scale_warning } =
        input::supporter(path, file, &placement, &arguments.cloud, params.seed)?;
    let cloud = input::seen(&file, &arguments.cloud)?;
    let start = Instant::now();
    let mut memory = Vec::new();
    let supporter = analyze_supporter(&cloud, &params, &mut memory, &Monitor::new())?;
    let seconds = start.elapsed().as_secs_f64();
    input::tell_of_cloud(path, &supporter, &cloud);
    let extents = supporter.aabb().extents();
    let inspected = InspectedSupporter {
        schema: json::SCHEMA,
        role: "supporter",
        points: cloud.points().len(),
        extents: extents.into(),
        scale_warning,
        points_merged: supporter.cleaning().merged,
        strays: supporter.cleaning().strays,
        points_on_planes: supporter.cleaning().on_planes,
        normals_estimated: supporter.normals().estimated,
        normals_renormalised: supporter.normals().renormalised,
        counts: supporter.counts().into(),
        sites: json::sites(supporter.sites()),
        contacts: supporter.contacts().collect(),
        seconds,
    };
    if arguments.json {
        return Ok(json::text(&inspected));
    }
    let mut text = format!(
        "supporter, {} points, {} normals estimated, {} renormalised\n",
        inspected.points, inspected.normals_estimated, inspected.normals_renormalised
    );
    text += &format!(
        "cleaning        {} points merged with others, {} strays dropped, {} left on walls and tables\n",
        inspected.points_merged, inspected.strays, inspected.points_on_planes
    );
    text += &format!("size            {} mm\n", millimetres(&extents));
    text += &scale(&inspected.scale_warning);
    text += &match supporter.counts() {
        SupporterCounts::Sites(counts) => format!(
            "contact points  {}, in {} clusters, {} of them sites\n",
            counts.contact_points, counts.clusters, counts.sites
        ),
        SupporterCounts::Contacts(counts) => {
            format!(
                "contact points  {}, {} of them contact candidates\n",
                counts.contact_points, counts.contacts
            )
        }
    };
    if supporter.contacts().len() > 0 {
        text += "index  position, mm               bar direction\n";
    }
    for (index, contact) in supporter.contacts().enumerate().take(SHOWN) {
        text += &format!(
            "{index:5}  {}  {}\n",
            millimetres(&contact.position.coords),
            direction(&contact.bar_direction)
        );
    }
    if supporter.sites().len() > 0 {
        text += "site  position, mm               hanging direction      radius, mm  to the boundary, mm\n";
    }
    for (index, site) in supporter.sites().enumerate() {
        let [d1, d2] = site.boundary_distances.map(|d| d * 1000.0);
        text += &format!(
            "{index:4}  {}  {}  {:10.1}  {d1:8.1}  {d2:8.1}\n",
            millimetres(&site.position.coords),
            direction(&site.hanging_direction),
            site.support_radius * 1000.0,
        );
    }
    Ok(text)
}

/// Maximum number of contact candidates that are listed; the JSON has all of them.
const SHOWN: usize = 10;

fn scale(warning: &Option<String>) -> String {
    let plausible = || format!("plausible, between {TOO_SMALL} and {TOO_LARGE} m");
    format!("scale           {}\n", warning.clone().unwrap_or_else(plausible))
}

/// Whether the mesh bounds a volume, in words.
pub(super) fn closedness(mass: &MassProperties) -> &'static str {
    match (mass.is_closed, mass.is_inside_out) {
        (false, _) => "open",
        (true, false) => "closed",
        (true, true) => "closed but inside out, so its triangles were reversed",
    }
}

fn millimetres(v: &Vector) -> String {
    let [x, y, z] = [v.x, v.y, v.z].map(|x| 1000.0 * x);
    format!("{x:8.1} {y:8.1} {z:8.1}")
}

fn direction(v: &Vector) -> String {
    format!("{:6.3} {:6.3} {:6.3}", v.x, v.y, v.z)
}

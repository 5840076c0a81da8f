//! Depth images.

use crate::arrays::array;
use crate::{errors, work};
use hangpose::files::depth::{DepthFile, ScanFrame, pose_of_rows};
use hangpose::geometry::Aabb;
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::depth::DepthCamera;
use hangpose::perception::depth_points::DepthPointsSettings;
use hangpose::perception::volume::VolumeSettings;
use hangpose::{CLOUD_VOXEL, Monitor, complete_scan, suggested_voxel};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An image: depths, metres per unit of depth, labels, and the row-major matrix from camera to world coordinates.
type Image<'py> = (PyReadonlyArray2<'py, u16>, f32, Option<PyReadonlyArray2<'py, u8>>, [[f64; 4]; 4]);

/// What all images have in common.
#[derive(FromPyObject)]
pub(crate) struct Common {
    #[pyo3(item)]
    intrinsics: [[f32; 3]; 3],
    #[pyo3(item)]
    distortion: [f32; 5],
    #[pyo3(item)]
    label: u8,
    #[pyo3(item)]
    voxel: Option<f32>,
    #[pyo3(item)]
    crop: Option<[[f32; 3]; 2]>,
    #[pyo3(item)]
    max_depth: f32,
}

impl Common {
    fn crop(&self) -> Option<Aabb> {
        self.crop.map(|[min, max]| Aabb { min: min.into(), max: max.into() })
    }

    fn frames(&self, py: Python<'_>, images: &[Image]) -> PyResult<Vec<ScanFrame>> {
        images.iter().enumerate().map(|(index, image)| self.frame(py, index, image)).collect()
    }

    fn frame(
        &self,
        py: Python<'_>,
        index: usize,
        (depths, scale, labels, pose): &Image,
    ) -> PyResult<ScanFrame> {
        let wrong = |field: &str, text: String| {
            errors::element(py, field, Some(index), &format!("image {index} (counted from 0): {text}"))
        };
        let size = [depths.shape()[1] as u32, depths.shape()[0] as u32];
        let [[fx, _, cx], [_, fy, cy], _] = self.intrinsics;
        let camera = DepthCamera::new(size, [fx, fy], [cx, cy], self.distortion)
            .map_err(|error| wrong("intrinsics", error.to_string()))?;
        let pose = pose_of_rows(pose.as_flattened()).map_err(|reason| wrong("poses", reason))?;
        let values = depths.as_array().iter().copied().collect();
        let labels = match labels {
            Some(labels) if labels.shape() != depths.shape() => {
                return Err(wrong("masks", "the mask has not the size of the depth image".into()));
            }
            labels => labels.as_ref().map(|labels| (labels.as_array().iter().copied().collect(), self.label)),
        };
        Ok(ScanFrame {
            depth: DepthFile { path: format!("image {index}").into(), size, depths: values },
            labels,
            camera,
            scale: *scale,
            pose,
        })
    }
}

/// The mesh that depth images show: `vertices`, `triangles`, `seen` and `viewpoints`.
#[pyfunction]
pub(crate) fn scan<'py>(
    py: Python<'py>,
    images: Vec<Image<'py>>,
    common: Common,
    complete: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let frames = common.frames(py, &images)?;
    let crop = common.crop();
    let max_depth = common.max_depth;
    let monitor = Monitor::new();
    let scanned = work::run(py, &monitor, progress, || {
        let voxel = common.voxel.unwrap_or_else(|| suggested_voxel(&frames, max_depth, crop));
        let settings = VolumeSettings { crop, max_depth, ..VolumeSettings::new(voxel) };
        match complete {
            true => complete_scan(&frames, &settings, &CompletionSettings::default(), &monitor),
            false => hangpose::scan(&frames, &settings, &monitor),
        }
    })?;
    let scanned = scanned.map_err(|error| errors::fuse(py, &error))?;
    let result = PyDict::new(py);
    result.set_item("vertices", array(py, scanned.vertices))?;
    result.set_item("triangles", array(py, scanned.triangles))?;
    result.set_item("seen", numpy::PyArray1::from_vec(py, scanned.seen))?;
    result.set_item("viewpoints", array(py, scanned.viewpoints))?;
    result.set_item("agreement", scanned.agreement)?;
    Ok(result)
}

/// The cloud that depth images show: `points`, `normals` and `viewpoints`.
#[pyfunction]
pub(crate) fn scan_cloud<'py>(
    py: Python<'py>,
    images: Vec<Image<'py>>,
    common: Common,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let frames = common.frames(py, &images)?;
    let (crop, max_depth) = (common.crop(), common.max_depth);
    let settings = DepthPointsSettings { crop, max_depth, ..DepthPointsSettings::default() };
    let voxel = common.voxel.unwrap_or(CLOUD_VOXEL);
    let scanned =
        work::run(py, &Monitor::new(), progress, || hangpose::scan_cloud(&frames, voxel, &settings))?;
    let scanned = scanned.map_err(|error| errors::fuse(py, &error))?;
    let cloud = scanned.cloud;
    let result = PyDict::new(py);
    result.set_item("points", array(py, cloud.points))?;
    result.set_item("normals", array(py, cloud.normals.unwrap_or_default()))?;
    result.set_item("viewpoints", array(py, cloud.viewpoints))?;
    result.set_item("agreement", scanned.agreement)?;
    Ok(result)
}

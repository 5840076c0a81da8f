//! Objects and supporters with their memory.

use crate::arrays::{array, rows};
use crate::{errors, work};
use hangpose::files::{CloudFile, MeshFile};
use hangpose::geometry::{Cloud, Mesh};
use hangpose::hanging::{Object, Supporter};
use hangpose::memory::Limits;
use hangpose::{Monitor, Params, TooLarge};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use self_cell::{MutBorrow, self_cell};

type Memory = MutBorrow<Vec<u8>>;

self_cell!(
    struct ObjectCell {
        owner: Memory,
        #[covariant]
        dependent: Object,
    }
);

self_cell!(
    struct SupporterCell {
        owner: Memory,
        #[covariant]
        dependent: Supporter,
    }
);

/// An object, analysed, with its mesh.
#[pyclass(frozen, module = "hangpose._hangpose")]
pub(crate) struct NativeObject {
    cell: ObjectCell,
    /// For the page that shows it.
    mesh: MeshFile,
    pub(crate) params: Params,
}

/// A supporter, analysed, with its cloud.
#[pyclass(frozen, module = "hangpose._hangpose")]
pub(crate) struct NativeSupporter {
    cell: SupporterCell,
    /// For the page that shows it.
    cloud: CloudFile,
}

impl NativeObject {
    pub(crate) fn object(&self) -> &Object<'_> {
        self.cell.borrow_dependent()
    }

    /// The mesh, which was valid when the object was made.
    pub(crate) fn mesh(&self) -> Option<Mesh<'_>> {
        self.mesh.mesh().ok()
    }
}

impl NativeSupporter {
    pub(crate) fn supporter(&self) -> &Supporter<'_> {
        self.cell.borrow_dependent()
    }

    /// The cloud, which was valid when the supporter was made.
    pub(crate) fn cloud(&self) -> Option<Cloud<'_>> {
        self.cloud.cloud().ok()
    }
}

#[pymethods]
impl NativeObject {
    #[new]
    fn new(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f32>,
        triangles: PyReadonlyArray2<'_, u32>,
        viewpoints: PyReadonlyArray2<'_, f32>,
        params: &Bound<'_, PyAny>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let params: Params = depythonize(params)?;
        params.validate().map_err(|error| errors::params(py, &error))?;
        // Copies, since other threads may write to the arrays while the analysis runs.
        let file = MeshFile {
            vertices: rows(py, "vertices", &vertices)?.to_vec(),
            triangles: rows(py, "triangles", &triangles)?.to_vec(),
            viewpoints: rows(py, "viewpoints", &viewpoints)?.to_vec(),
            notes: Vec::new(),
        };
        TooLarge::check_mesh(&file).map_err(|error| errors::too_large(py, &error))?;
        let mesh = file.mesh().map_err(|error| errors::mesh(py, &error))?;
        let monitor = Monitor::new();
        let memory = MutBorrow::new(vec![0; Object::bytes(&Object::limits(&mesh, &params))]);
        let analysed = work::run(py, &monitor, progress, || {
            ObjectCell::try_new(memory, |memory| {
                Object::analyze(&mesh, &params, memory.borrow_mut(), &monitor)
            })
        })?;
        let cell = analysed.map_err(|error| errors::analysis(py, &error))?;
        Ok(Self { cell, mesh: file, params })
    }

    /// Centre of mass in object coordinates, metres.
    #[getter]
    fn centre_of_mass(&self) -> [f32; 3] {
        self.object().centre_of_mass().into()
    }

    /// Area, volume and closedness.
    #[getter]
    fn mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize(py, self.object().mass())?)
    }

    /// Axes of symmetry and their folds, 0 for any angle.
    #[getter]
    fn symmetries(&self) -> Vec<([f32; 3], u32)> {
        self.object().symmetries().iter().map(|symmetry| (symmetry.axis.into(), symmetry.fold)).collect()
    }

    /// Positions of the contact candidates, or of the hanging sites.
    #[getter]
    fn places<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        let contacts = self.object().contacts().map(|contact| contact.position.into());
        let sites = self.object().sites().map(|site| site.position.into());
        array::<f32>(py, contacts.chain(sites).collect()).into_any()
    }

    #[getter]
    fn triangle_count(&self) -> usize {
        self.mesh.triangles.len()
    }
}

#[pymethods]
impl NativeSupporter {
    #[new]
    fn new(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f32>,
        normals: Option<PyReadonlyArray2<'_, f32>>,
        viewpoints: PyReadonlyArray2<'_, f32>,
        region: Option<[[f32; 3]; 2]>,
        params: &Bound<'_, PyAny>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let params: Params = depythonize(params)?;
        params.validate().map_err(|error| errors::params(py, &error))?;
        let normals = normals.as_ref().map(|normals| rows(py, "normals", normals)).transpose()?;
        // Copies, since other threads may write to the arrays while the analysis runs.
        let file = CloudFile {
            points: rows(py, "points", &points)?.to_vec(),
            normals: normals.map(<[_]>::to_vec),
            viewpoints: rows(py, "viewpoints", &viewpoints)?.to_vec(),
            ..CloudFile::default()
        };
        TooLarge::check_cloud(&file).map_err(|error| errors::too_large(py, &error))?;
        let cloud = file.cloud().and_then(|cloud| match region {
            Some([low, high]) => cloud.hang_within(low, high),
            None => Ok(cloud),
        });
        let cloud = cloud.map_err(|error| errors::cloud(py, &error))?;
        let monitor = Monitor::new();
        let memory = MutBorrow::new(vec![0; Supporter::bytes(&Limits::of_points(file.points.len()))]);
        let analysed = work::run(py, &monitor, progress, || {
            SupporterCell::try_new(memory, |memory| {
                Supporter::analyze(&cloud, &params, memory.borrow_mut(), &monitor)
            })
        })?;
        let cell = analysed.map_err(|error| errors::analysis(py, &error))?;
        Ok(Self { cell, cloud: file })
    }

    /// Positions of the contact candidates, or of the support sites.
    #[getter]
    fn places<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        let contacts = self.supporter().contacts().map(|contact| contact.position.into());
        let sites = self.supporter().sites().map(|site| site.position.into());
        array::<f32>(py, contacts.chain(sites).collect()).into_any()
    }

    /// Number of points that were given.
    #[getter]
    fn point_count(&self) -> usize {
        self.cloud.points.len()
    }

    /// Number of points of the far side that were guessed.
    #[getter]
    fn guessed(&self) -> usize {
        self.supporter().guessed()
    }
}

// ODE with the interface of engine.h: the object's triangles against capsules, boxes and triangles.
#include "engine.h"

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

namespace {

constexpr int MOST_FOUND = 256;     // largest number of contacts that ODE finds per pair of shapes
constexpr size_t MOST_KEPT = 16;    // largest number of contacts that are solved
constexpr double MERGE = 0.001;     // distance below which contacts with similar normals are merged, m
constexpr double ALIKE = 0.95;      // cosine of the angle above which normals are similar
constexpr double LOAD = 0.01;       // smallest load of a contact, as an acceleration: a thousandth of the weight
constexpr double LAYER = 0.00005;   // penetration that is not corrected, so that contacts persist, m

// Lock for every collision, load and release of triangles. ODE may be built without thread-local data, as Debian's is;
// then all threads share the caches of its triangle colliders.
std::mutex& colliders() {
    static std::mutex mutex;
    return mutex;
}

// Registers a thread with ODE, which every colliding thread requires.
struct Thread {
    Thread() {
        static std::once_flag once;
        std::call_once(once, [] { dInitODE2(0); });
        std::lock_guard<std::mutex> lock(colliders());
        dAllocateODEDataForThread(dAllocateMaskAll);
    }
};

struct Triangles {
    std::vector<double> vertices;
    std::vector<dTriIndex> corners;
    dTriMeshDataID data = dGeomTriMeshDataCreate();
    ~Triangles() { dGeomTriMeshDataDestroy(data); }
};

struct World {
    dWorldID world = dWorldCreate();
    // Its own implementation, because all worlds share the default one without locks.
    dThreadingImplementationID threading = dThreadingAllocateSelfThreadedImplementation();
    dJointGroupID joints = dJointGroupCreate(0);
    dBodyID body = dBodyCreate(world);
    std::vector<dGeomID> moving, fixed;
    std::vector<std::unique_ptr<Triangles>> meshes;
    std::vector<dContactGeom> found = std::vector<dContactGeom>(MOST_FOUND);
    std::vector<dContactGeom> all;
    std::vector<dContactGeom> kept;
    std::array<dJointFeedback, MOST_KEPT> forces;
    Setup setup;

    explicit World(const Setup& given) : setup(given) {
        dWorldSetStepThreadingImplementation(world, dThreadingImplementationGetFunctions(threading), threading);
        dMass mass;
        dMassSetParameters(&mass, setup.mass, 0, 0, 0, setup.inertia[0], setup.inertia[1], setup.inertia[2], 0, 0, 0);
        dBodySetMass(body, &mass);
        dWorldSetERP(world, 0.2);
        dWorldSetCFM(world, 1e-6);
        dWorldSetContactMaxCorrectingVel(world, 0.1);
        dWorldSetContactSurfaceLayer(world, LAYER);
        dWorldSetAutoDisableFlag(world, 0);
        dBodySetAngularDamping(body, 1 - std::exp(-setup.damping * setup.time_step));
        dBodySetAngularDampingThreshold(body, 0);
    }

    ~World() {
        dJointGroupDestroy(joints);
        for (dGeomID geom : moving) dGeomDestroy(geom);
        for (dGeomID geom : fixed) dGeomDestroy(geom);
        dWorldDestroy(world);
        dThreadingFreeImplementation(threading);
    }

    // The columns of `turn` are the axes of the shape.
    void add(bool to_body, dGeomID geom, const double* centre, const dMatrix3 turn) {
        if (to_body) {
            dGeomSetBody(geom, body);
            dGeomSetOffsetPosition(geom, centre[0], centre[1], centre[2]);
            dGeomSetOffsetRotation(geom, turn);
            moving.push_back(geom);
        } else {
            dGeomSetPosition(geom, centre[0], centre[1], centre[2]);
            dGeomSetRotation(geom, turn);
            fixed.push_back(geom);
        }
    }

    // Collects all contacts, deepest first. Normals point into the body.
    void collide() {
        all.clear();
        std::lock_guard<std::mutex> lock(colliders());
        for (dGeomID mine : moving) {
            dReal a[6];
            dGeomGetAABB(mine, a);
            for (dGeomID other : fixed) {
                dReal b[6];
                dGeomGetAABB(other, b);
                if (a[0] > b[1] || b[0] > a[1] || a[2] > b[3] || b[2] > a[3] || a[4] > b[5] || b[4] > a[5]) continue;
                int count = dCollide(mine, other, MOST_FOUND, found.data(), sizeof(dContactGeom));
                for (int i = 0; i < count; ++i)
                    if (std::isfinite(found[i].depth) && dCalcVectorLengthSquare3(found[i].normal) > 0.5)
                        all.push_back(found[i]);
            }
        }
        std::stable_sort(all.begin(), all.end(),
                         [](const dContactGeom& x, const dContactGeom& y) { return x.depth > y.depth; });
    }

    // Triangles produce many contacts at one place: of those that are close and have similar normals the deepest is
    // kept.
    void thin_out() {
        kept.clear();
        for (const dContactGeom& contact : all) {
            bool known = false;
            for (const dContactGeom& other : kept)
                known |= dCalcPointsDistance3(contact.pos, other.pos) < MERGE &&
                         dCalcVectorDot3(contact.normal, other.normal) > ALIKE;
            if (!known) kept.push_back(contact);
            if (kept.size() == MOST_KEPT) break;
        }
    }
};

World& of(void* world) { return *static_cast<World*>(world); }

void* create(const Setup* setup) {
    static thread_local Thread thread;
    (void)thread;
    return new World(*setup);
}

void destroy(void* world) {
    std::lock_guard<std::mutex> lock(colliders());
    delete static_cast<World*>(world);
}

void add_capsule(void* world, bool body, const double* from, const double* to, double radius) {
    double axis[3], centre[3], length = 0;
    for (int i = 0; i < 3; ++i) {
        axis[i] = to[i] - from[i];
        centre[i] = (to[i] + from[i]) / 2;
        length += axis[i] * axis[i];
    }
    length = std::sqrt(length);
    dMatrix3 turn;
    if (length > 0) dRFromZAxis(turn, axis[0], axis[1], axis[2]);
    else dRSetIdentity(turn);
    of(world).add(body, dCreateCapsule(nullptr, radius, length), centre, turn);
}

void add_box(void* world, bool body, const double* centre, const double* axes, const double* half_extents) {
    dMatrix3 turn = {axes[0], axes[3], axes[6], 0, axes[1], axes[4], axes[7], 0, axes[2], axes[5], axes[8], 0};
    const double* half = half_extents;
    of(world).add(body, dCreateBox(nullptr, 2 * half[0], 2 * half[1], 2 * half[2]), centre, turn);
}

void add_mesh(void* world, bool body, const double* vertices, size_t vertex_count, const uint32_t* triangles,
              size_t triangle_count) {
    std::lock_guard<std::mutex> lock(colliders());
    auto mesh = std::make_unique<Triangles>();
    mesh->vertices.assign(vertices, vertices + 3 * vertex_count);
    mesh->corners.assign(triangles, triangles + 3 * triangle_count);
    dGeomTriMeshDataBuildDouble(mesh->data, mesh->vertices.data(), 3 * sizeof(double), int(vertex_count),
                                mesh->corners.data(), int(mesh->corners.size()), 3 * sizeof(dTriIndex));
    dMatrix3 turn;
    dRSetIdentity(turn);
    const double origin[3] = {0, 0, 0};
    of(world).add(body, dCreateTriMesh(nullptr, mesh->data, nullptr, nullptr, nullptr), origin, turn);
    of(world).meshes.push_back(std::move(mesh));
}

void place(void* handle, const State* state) {
    World& it = of(handle);
    const double *p = state->position, *q = state->rotation, *v = state->velocity, *w = state->spin;
    const dQuaternion rotation = {q[3], q[0], q[1], q[2]};
    dBodySetPosition(it.body, p[0], p[1], p[2]);
    dBodySetQuaternion(it.body, rotation);
    dBodySetLinearVel(it.body, v[0], v[1], v[2]);
    dBodySetAngularVel(it.body, w[0], w[1], w[2]);
}

void pull(void* handle, const double* gravity) {
    dWorldSetGravity(of(handle).world, gravity[0], gravity[1], gravity[2]);
}

uint32_t step(void* handle, uint32_t count) {
    World& it = of(handle);
    uint32_t loaded = 0;
    for (uint32_t i = 0; i < count; ++i) {
        it.collide();
        it.thin_out();
        for (size_t j = 0; j < it.kept.size(); ++j) {
            dContact contact = {};
            contact.geom = it.kept[j];
            contact.surface.mode = dContactApprox1;
            contact.surface.mu = it.setup.friction;
            dJointID joint = dJointCreateContact(it.world, it.joints, &contact);
            dJointAttach(joint, it.body, nullptr);
            dJointSetFeedback(joint, &it.forces[j]);
        }
        dWorldStep(it.world, it.setup.time_step);
        dJointGroupEmpty(it.joints);
        bool bears = false;
        for (size_t j = 0; j < it.kept.size(); ++j)
            bears |= dCalcVectorLength3(it.forces[j].f1) > LOAD * it.setup.mass;
        loaded += bears;
    }
    return loaded;
}

void read(void* handle, State* state) {
    dBodyID body = of(handle).body;
    const dReal* q = dBodyGetQuaternion(body);
    for (int i = 0; i < 3; ++i) {
        state->position[i] = dBodyGetPosition(body)[i];
        state->velocity[i] = dBodyGetLinearVel(body)[i];
        state->spin[i] = dBodyGetAngularVel(body)[i];
        state->rotation[i] = q[i + 1];
    }
    state->rotation[3] = q[0];
}

double penetration(void* handle) {
    World& it = of(handle);
    it.collide();
    return it.all.empty() ? 0 : std::max(0.0, double(it.all[0].depth));
}

}  // namespace

extern "C" const Engine hangpose_ode;
const Engine hangpose_ode = {create, nullptr, add_capsule, add_box,     add_mesh, place,
                             pull,   step,    read,        penetration, destroy};

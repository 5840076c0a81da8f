// Bullet with the interface of engine.h: convex parts against convex parts.
#include "engine.h"

#include <btBulletDynamicsCommon.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

namespace {

// Length units per metre. Bullet's tolerances are absolute and meant for large objects, so the world is simulated in
// centimetres: in metres, pendulums, depths and wedges come out wrong.
constexpr double SCALE = 100;
constexpr btScalar MARGIN = btScalar(0.0002 * SCALE);
// Displacement at which a contact is discarded. Stale contacts hold the body: a pendulum on a thin bar is 2.4 % fast
// with 1 mm, and 0.7 % fast with this value.
constexpr btScalar BREAKING = btScalar(0.0001 * SCALE);
// Smallest load of a contact, as an acceleration: a thousandth of the weight.
constexpr btScalar LOAD = btScalar(0.01 * SCALE);

btVector3 vector(const double* v, double scale = 1) {
    return {btScalar(v[0] * scale), btScalar(v[1] * scale), btScalar(v[2] * scale)};
}

btVector3 scaled(const double* v) { return vector(v, SCALE); }

struct Deepest : btCollisionWorld::ContactResultCallback {
    btScalar distance = 0;
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
        distance = std::min(distance, point.getDistance());
        return 0;
    }
};

// A hull in the frame of its compound, for a quick separation test of two parts whose boxes overlap. Shells have so
// many such pairs that Bullet's narrow phase would take nearly all of the time.
struct Facets {
    bool of_body;
    std::vector<btVector3> corners;
    std::vector<btVector4> planes;  // outward normal and offset

    btVector3 middle{0, 0, 0};
    btScalar reach = 0;  // largest distance of a corner from the middle

    // The bounding ball is tested first, since it is much cheaper.
    bool is_beyond(const Facets& other, const btTransform& to_other) const {
        constexpr btScalar NEAR = 2 * (MARGIN + BREAKING);
        btVector3 ball = to_other * middle;
        for (const btVector4& plane : other.planes) {
            btScalar height = ball.dot(plane) - plane.w();
            if (height > NEAR + reach) return true;
            if (height < NEAR) continue;
            btVector3 normal = plane * to_other.getBasis();
            btScalar least = NEAR - height + normal.dot(middle);
            if (std::all_of(corners.begin(), corners.end(), [&](const btVector3& c) { return normal.dot(c) > least; }))
                return true;
        }
        return false;
    }
};

// The body of the world that this thread steps.
thread_local const btCollisionObject* current = nullptr;

bool are_close(const btCollisionShape* a, const btCollisionShape* b) {
    const auto* facets = static_cast<const Facets*>(a->getUserPointer());
    const auto* others = static_cast<const Facets*>(b->getUserPointer());
    if (!facets || !others || !current) return true;
    if (!facets->of_body) std::swap(facets, others);
    const btTransform& pose = current->getWorldTransform();
    return !facets->is_beyond(*others, pose) && !others->is_beyond(*facets, pose.inverse());
}

struct World {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btCompoundShape compound, fixed_compound;
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<Facets>> facets;
    btCollisionObject fixed;
    std::unique_ptr<btRigidBody> body;
    btScalar time_step, friction;

    explicit World(const Setup& setup) : time_step(btScalar(setup.time_step)), friction(btScalar(setup.friction)) {
        static std::once_flag once;
        std::call_once(once, [] {
            gContactBreakingThreshold = BREAKING;
            gCompoundCompoundChildShapePairCallback = are_close;
        });
        dispatcher.setDispatcherFlags(dispatcher.getDispatcherFlags() &
                                      ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
        world.setForceUpdateAllAabbs(false);
        btContactSolverInfo& info = world.getSolverInfo();
        info.m_splitImpulsePenetrationThreshold = 0;  // overlap is pushed apart without gaining speed
        info.m_restitutionVelocityThreshold *= btScalar(SCALE);
        // Friction in two fixed directions. The default single direction follows the slip and creeps without slip.
        info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
        btRigidBody::btRigidBodyConstructionInfo of_body(static_cast<btScalar>(setup.mass), nullptr, &compound,
                                                         vector(setup.inertia, SCALE * SCALE));
        of_body.m_friction = friction;  // Bullet multiplies both coefficients; the fixed shapes have 1
        of_body.m_angularDamping = btScalar(1 - std::exp(-setup.damping));  // the fraction lost per second
        body = std::make_unique<btRigidBody>(of_body);
        body->setActivationState(DISABLE_DEACTIVATION);
        fixed.setCollisionShape(&fixed_compound);
        fixed.setFriction(1);
    }

    ~World() {
        if (body->getBroadphaseHandle()) world.removeRigidBody(body.get());
        if (fixed.getBroadphaseHandle()) world.removeCollisionObject(&fixed);
    }

    void add(bool to_body, std::unique_ptr<btCollisionShape> shape, const btTransform& pose) {
        (to_body ? compound : fixed_compound).addChildShape(pose, shape.get());
        shapes.push_back(std::move(shape));
    }

    bool loaded() {
        btScalar least = LOAD * time_step / body->getInvMass();
        for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
            const btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
            for (int j = 0; j < manifold->getNumContacts(); ++j)
                if (manifold->getContactPoint(j).getAppliedImpulse() > least) return true;
        }
        return false;
    }
};

World& of(void* world) { return *static_cast<World*>(world); }

void* create(const Setup* setup) { return new World(*setup); }

void destroy(void* world) { delete static_cast<World*>(world); }

// The margin expands a hull, so the hull is shrunk by the margin first.
void add_hull(void* world, bool body, const double* points, size_t count) {
    if (count == 0) return;
    std::vector<btVector3> all;
    btVector3 middle(0, 0, 0);
    for (size_t i = 0; i < count; ++i) all.push_back(scaled(points + 3 * i));
    for (const btVector3& point : all) middle += point / btScalar(count);
    for (btVector3& point : all) point -= middle;
    btConvexHullComputer hull;
    btScalar shrunk = hull.compute(all[0].m_floats, sizeof(btVector3), int(count), MARGIN, btScalar(0.5));
    if (shrunk < 0 || hull.vertices.size() == 0) hull.compute(all[0].m_floats, sizeof(btVector3), int(count), 0, 0);
    auto shape = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < hull.vertices.size(); ++i) shape->addPoint(hull.vertices[i], false);
    auto facets = std::make_unique<Facets>();
    facets->of_body = body;
    facets->middle = middle;
    for (int i = 0; i < hull.vertices.size(); ++i) {
        facets->corners.push_back(hull.vertices[i] + middle);
        facets->reach = std::max(facets->reach, hull.vertices[i].length());
    }
    for (int i = 0; i < hull.faces.size(); ++i) {
        const auto* edge = &hull.edges[hull.faces[i]];
        const btVector3& corner = hull.vertices[edge->getSourceVertex()];
        const btVector3& next = hull.vertices[edge->getTargetVertex()];
        const btVector3& last = hull.vertices[edge->getNextEdgeOfFace()->getTargetVertex()];
        btVector3 normal = (next - corner).cross(last - corner);
        if (normal.length2() == 0) continue;
        normal.normalize();
        btScalar along = normal.dot(corner);  // the middle is inside
        if (along < 0) normal = -normal;
        btVector4 plane(normal.x(), normal.y(), normal.z(), std::abs(along) + normal.dot(middle));
        facets->planes.push_back(plane);
    }
    // Bullet computes no hull of a flat set, and a shape without points crashes it.
    if (hull.vertices.size() == 0)
        for (const btVector3& point : all) shape->addPoint(point, false);
    shape->recalcLocalAabb();
    shape->setMargin(std::max(shrunk, btScalar(0)));
    if (hull.vertices.size() > 0) shape->setUserPointer(facets.get());
    of(world).facets.push_back(std::move(facets));
    of(world).add(body, std::move(shape), btTransform(btQuaternion::getIdentity(), middle));
}

void add_capsule(void* world, bool body, const double* from, const double* to, double radius) {
    btVector3 a = scaled(from), b = scaled(to), axis = b - a;
    btScalar length = axis.length();
    btQuaternion turn = btQuaternion::getIdentity();
    if (length > 0) turn = shortestArcQuat(btVector3(0, 0, 1), axis / length);
    auto shape = std::make_unique<btCapsuleShapeZ>(btScalar(radius * SCALE), length);
    of(world).add(body, std::move(shape), btTransform(turn, (a + b) / 2));
}

void add_box(void* world, bool body, const double* centre, const double* axes, const double* half_extents) {
    btVector3 x = vector(axes), y = vector(axes + 3), z = vector(axes + 6);
    btMatrix3x3 turn(x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]);
    btVector3 half = scaled(half_extents);
    auto shape = std::make_unique<btBoxShape>(half);  // includes its margin
    shape->setMargin(std::min(MARGIN, half[half.minAxis()] / 2));
    of(world).add(body, std::move(shape), btTransform(turn, scaled(centre)));
}

void place(void* handle, const State* state) {
    World& it = of(handle);
    if (it.body->getBroadphaseHandle()) it.world.removeRigidBody(it.body.get());
    // The bounds are those of all shapes, which are complete only now.
    if (!it.fixed.getBroadphaseHandle())
        it.world.addCollisionObject(&it.fixed, btBroadphaseProxy::StaticFilter,
                                    btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
    btQuaternion rotation;
    for (int i = 0; i < 4; ++i) rotation[i] = btScalar(state->rotation[i]);
    btTransform pose(rotation.normalized(), scaled(state->position));
    it.body->setWorldTransform(pose);
    it.body->setInterpolationWorldTransform(pose);
    it.body->setLinearVelocity(scaled(state->velocity));
    it.body->setAngularVelocity(vector(state->spin));
    it.body->updateInertiaTensor();
    it.body->clearForces();
    it.world.addRigidBody(it.body.get());
    it.solver.reset();
}

void pull(void* handle, const double* gravity) { of(handle).world.setGravity(scaled(gravity)); }

uint32_t step(void* handle, uint32_t count) {
    World& it = of(handle);
    current = it.body.get();
    uint32_t loaded = 0;
    for (uint32_t i = 0; i < count; ++i) {
        it.world.stepSimulation(it.time_step, 0);
        loaded += it.loaded();
    }
    return loaded;
}

void read(void* handle, State* state) {
    const btRigidBody& body = *of(handle).body;
    btQuaternion q = body.getWorldTransform().getRotation();
    for (int i = 0; i < 3; ++i) {
        state->position[i] = body.getWorldTransform().getOrigin()[i] / SCALE;
        state->velocity[i] = body.getLinearVelocity()[i] / SCALE;
        state->spin[i] = body.getAngularVelocity()[i];
    }
    for (int i = 0; i < 4; ++i) state->rotation[i] = q[i];
}

double penetration(void* handle) {
    World& it = of(handle);
    current = it.body.get();
    Deepest deepest;
    it.world.contactPairTest(it.body.get(), &it.fixed, deepest);
    return -deepest.distance / SCALE;
}

}  // namespace

extern "C" const Engine hangpose_bullet;
const Engine hangpose_bullet = {create, add_hull, add_capsule, add_box,     nullptr, place,
                                pull,   step,     read,        penetration, destroy};

// OMPL's RRT-Connect in SE(3) with a collision checker of the caller. Mirrored in ompl.rs.
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

namespace ob = ompl::base;
namespace og = ompl::geometric;

// A pose is x, y, z of the centre of mass in metres and the quaternion x, y, z, w.
using IsFree = bool (*)(void* context, const double* pose);

extern "C" {
struct OmplProblem {
    double start[7];
    double goal[7];
    double low[3];  // bounds of the centre of mass
    double high[3];
    double reach;       // distance from the centre of mass to the farthest point of the object, metres
    double resolution;  // of the tests between two states, metres
    double seconds;     // the time after which it gives up
};
}

namespace {

void set(ob::SE3StateSpace::StateType* state, const double* pose) {
    state->setXYZ(pose[0], pose[1], pose[2]);
    auto& q = state->rotation();
    q.x = pose[3], q.y = pose[4], q.z = pose[5], q.w = pose[6];
}

bool solve(const OmplProblem& problem, IsFree is_free, void* context) {
    auto space = std::make_shared<ob::SE3StateSpace>();
    ob::RealVectorBounds bounds(3);
    for (unsigned i = 0; i < 3; ++i) {
        bounds.setLow(i, problem.low[i]);
        bounds.setHigh(i, problem.high[i]);
    }
    space->setBounds(bounds);
    // A metric in metres: the distance of two rotations is half their angle.
    space->setSubspaceWeight(1, 2 * problem.reach);
    auto position = space->getSubspace(0), rotation = space->getSubspace(1);
    auto fraction = [](double length, double extent) { return std::min(1.0, length / extent); };
    position->setLongestValidSegmentFraction(fraction(problem.resolution, position->getMaximumExtent()));
    rotation->setLongestValidSegmentFraction(
        fraction(problem.resolution / (2 * problem.reach), rotation->getMaximumExtent()));
    og::SimpleSetup setup(space);
    setup.setStateValidityChecker([&](const ob::State* state) {
        const auto* at = state->as<ob::SE3StateSpace::StateType>();
        const auto& q = at->rotation();
        double pose[7] = {at->getX(), at->getY(), at->getZ(), q.x, q.y, q.z, q.w};
        return setup.getSpaceInformation()->satisfiesBounds(state) && is_free(context, pose);
    });
    ob::ScopedState<ob::SE3StateSpace> start(space), goal(space);
    set(start.get(), problem.start);
    set(goal.get(), problem.goal);
    setup.setStartAndGoalStates(start, goal);
    setup.setPlanner(std::make_shared<og::RRTConnect>(setup.getSpaceInformation()));
    return setup.solve(problem.seconds) == ob::PlannerStatus::EXACT_SOLUTION;
}

}  // namespace

// Returns whether a path was found and writes the time that it took, in seconds.
extern "C" bool hangpose_ompl(const OmplProblem* problem, IsFree is_free, void* context, double* seconds) {
    static std::once_flag once;
    std::call_once(once, [] {
        ompl::msg::noOutputHandler();
        ompl::RNG::setSeed(1);
    });
    auto begin = std::chrono::steady_clock::now();
    bool is_solved = false;
    try {
        is_solved = solve(*problem, is_free, context);
    } catch (const std::exception&) {
        // A start or goal that OMPL does not take is a problem that it does not solve.
    }
    *seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return is_solved;
}

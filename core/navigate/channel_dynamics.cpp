#include "core/navigate/channel_dynamics.hpp"

#include <string>

namespace driftlab {
namespace {

/// The states of all processes side by side, the bias first.
struct Stack {
  Eigen::MatrixXd phi, q;
  Eigen::VectorXd output, start;
  Eigen::MatrixXd start_covariance;
  double white = 0.0;
};

Result<Stack> stack_of(const Model& model, double bias_sd, double dt_s) {
  std::vector<StateSpace> parts;
  Eigen::Index states = bias_sd > 0.0 ? 1 : 0;
  for (const Process& process : model) {
    auto space = process.state_space(dt_s);
    if (!space) {
      return fail(ErrorCode::InvalidArgument,
                  "A filter cannot hold " + std::string(process.kind->title) + ": it has no state space.",
                  {{"process", std::string(process.kind->name)}});
    }
    states += space->phi.rows();
    parts.push_back(std::move(*space));
  }
  if (states > kMaxAxisStates) {
    return fail(ErrorCode::LimitExceeded, "The error model of one axis has more than 20 states.",
                {{"limit", std::to_string(kMaxAxisStates)}});
  }
  Stack stack;
  stack.phi = Eigen::MatrixXd::Zero(states, states);
  stack.q = stack.phi;
  stack.start_covariance = stack.phi;
  stack.output = Eigen::VectorXd::Zero(states);
  stack.start = stack.output;
  Eigen::Index at = 0;
  if (bias_sd > 0.0) {
    stack.phi(0, 0) = 1.0;
    stack.output(0) = 1.0;
    stack.start_covariance(0, 0) = bias_sd * bias_sd;
    at = 1;
  }
  for (const StateSpace& part : parts) {
    const Eigen::Index n = part.phi.rows();
    stack.phi.block(at, at, n, n) = part.phi;
    stack.q.block(at, at, n, n) = part.q;
    stack.start_covariance.block(at, at, n, n) = part.cov0;
    stack.output.segment(at, n) = part.h.transpose();
    stack.start.segment(at, n) = part.mean0;
    stack.white += part.r;
    at += n;
  }
  return stack;
}

}  // namespace

Result<ChannelDynamics> make_channel_dynamics(const Model& model, double bias_sd, double dt_s, int most) {
  auto made = stack_of(model, bias_sd, dt_s);
  if (!made) {
    return fail(made.error());
  }
  const Stack& stack = *made;
  const Eigen::Index n = stack.phi.rows();
  // One sample of (states, I1, I2, I3).
  const Eigen::Vector3d held(dt_s, dt_s * dt_s / 2.0, dt_s * dt_s * dt_s / 6.0);
  Eigen::MatrixXd one = Eigen::MatrixXd::Zero(n + 3, n + 3);
  one.topLeftCorner(n, n) = stack.phi;
  one.block(n, 0, 3, n) = held * stack.output.transpose();
  one.bottomRightCorner(3, 3) << 1.0, 0.0, 0.0, dt_s, 1.0, 0.0, dt_s * dt_s / 2.0, dt_s, 1.0;
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(n + 3, n + 3);
  noise.topLeftCorner(n, n) = stack.q;
  noise.bottomRightCorner(3, 3) = stack.white * held * held.transpose();

  ChannelDynamics dynamics;
  dynamics.states = static_cast<int>(n);
  dynamics.start = stack.start;
  dynamics.start_covariance = stack.start_covariance;
  dynamics.output = stack.output;
  dynamics.sample_phi = stack.phi;
  dynamics.diagonal = stack.phi.isDiagonal(0.0);
  Eigen::MatrixXd map = Eigen::MatrixXd::Identity(n + 3, n + 3);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n + 3, n + 3);
  for (int length = 1; length <= most; ++length) {
    map = one * map;
    sum = one * sum * one.transpose() + noise;
    ChannelStep step;
    step.phi = map.topLeftCorner(n, n);
    step.gain = map.block(n, 0, 3, n);
    step.state_noise = sum.topLeftCorner(n, n);
    step.cross_noise = sum.block(n, 0, 3, n);
    step.integral_noise = sum.bottomRightCorner(3, 3);
    dynamics.steps.push_back(std::move(step));
  }
  return dynamics;
}

}  // namespace driftlab

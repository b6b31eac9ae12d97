#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include <vicinity/robot/urdf_file.h>
#include <vicinity/teleop/device.h>
#include <vicinity/teleop/tick.h>
#include <vicinity/viscosity/field_file.h>

using namespace vicinity;

// Yours: the encoders of the arm in the operator's hand, and its motors.
void read_joints(double t, std::vector<double>& q) { q = {0.8 * std::sin(2 * t), 0.5}; }
void command_torques(const AxisVector& torque) { (void)torque; }

int main(int argc, char** argv) {
  if (argc != 4) return std::puts("usage: arm_tick FIELD URDF DEVICE"), 2;
  // Before the loop everything may take its time, and throws vicinity::Error.
  const ViscosityField field = open_field(argv[1]);
  const RobotModel robot = read_urdf(argv[2]).robot;
  TeleoperationOptions options{.memory = named_memory("rising")};
  options.limiter = limiter_options(read_device(argv[3]), LimiterMode::strict);
  Teleoperation arm(robot, sample_body_points(robot), field, options);

  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  std::vector<double> q(2);
  Input input{.q = q.data(), .joint_count = arm.joint_count()};
  Output output, strongest;
  // In the loop tick() takes no memory and no lock, and never throws.
  for (int k = 0; k < 3000; ++k) {
    std::this_thread::sleep_until(start + k * std::chrono::milliseconds(1));
    input.time_s = std::chrono::duration<double>(Clock::now() - start).count();
    read_joints(input.time_s, q);
    const Status status = arm.tick(input, output);
    command_torques(output.torque);  // zero, and safe, from Status::deadline_missed on
    if (status == Status::ok && output.power > strongest.power) strongest = output;
  }
  const Reason& why = strongest.reason;
  if (why.object < 0) return 1;
  std::printf("most felt: %s near %s, at least %.0f mm away\n", robot.links[why.link].name.c_str(),
              field.objects()[why.object].name.c_str(), 1e3 * why.distance_m);
}

// Haply's Inverse Service for tests: it speaks the documented messages, with arms and grips that tests move, and every
// fault that a service may have.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pen/service/web_socket_server.hpp"

namespace riffler::test {

class InverseService {
 public:
  struct Arm {
    std::string id = "049D", type = "inverse3";
    std::array<double, 3> position{0, -0.12, 0.15}, velocity{};  // m, m/s
    bool calibrated = true, in_use = false, power_supply = true, ready = true, plugged = true;
    std::array<double, 3> force{};  // N, as last commanded
    std::chrono::steady_clock::time_point commanded{};
  };
  struct Grip {
    std::string list = "wireless_verse_grip", id = "61576";
    std::array<double, 4> orientation{1, 0, 0, 0};  // w x y z
    std::string buttons = R"("buttons":{"a":false,"b":false,"c":false})";
  };
  /// What the tests may change at any time, under the mutex.
  struct State {
    std::vector<Arm> arms{Arm{}};
    std::vector<Grip> grips{Grip{}};
    std::string version = "3.5.0.0";
    std::string project = "haply-inverse-service";
    int lose_every = 0;                  // loses each n-th answer
    std::chrono::microseconds delay{0};  // before each answer …
    int late_every = 1;                  // … or each n-th
    std::string nonsense;                // instead of every answer
    std::string inventory;               // instead of the first message
    int commands = 0, wrong_commands = 0, connections = 0;
    double most_force = 0;
  };

  InverseService() { start(); }
  /// The service ends, and everything that its connections were doing.
  void stop() { server_.reset(); }
  /// It begins again at the same port.
  void start() {
    server_ = std::make_unique<LoopbackServer>([this](Peer& peer) { serve(peer); }, port_);
    port_ = server_->port();
  }
  std::uint16_t port() const { return port_; }

  template <class F>
  auto with(F&& f) {
    const std::lock_guard lock(mutex_);
    return f(state_);
  }
  /// The force on an arm now: "if you stop sending them, the device returns to idle" (Control commands).
  double force(std::size_t arm = 0) {
    return with([&](State& s) {
      const Arm& a = s.arms[arm];
      if (std::chrono::steady_clock::now() - a.commanded > std::chrono::milliseconds(50)) return 0.0;
      return std::sqrt(a.force[0] * a.force[0] + a.force[1] * a.force[1] + a.force[2] * a.force[2]);
    });
  }

 private:
  static std::string vector(const char* names, const double* v, std::size_t n) {
    std::string out = "{";
    for (std::size_t k = 0; k < n; ++k) {
      char text[48];
      std::snprintf(text, sizeof text, "%s\"%c\":%.9g", k > 0 ? "," : "", names[k], v[k]);
      out += text;
    }
    return out + "}";
  }
  static std::string truth(bool b) { return b ? "true" : "false"; }

  static std::string arm_text(const Arm& a, bool full) {
    const std::string identity = R"({"position":{"x":0,"y":0,"z":0},"rotation":{"w":1,"x":0,"y":0,"z":0}})";
    std::string out = R"({"device_id":")" + a.id + R"(",)";
    if (full)
      out += R"("config":{"type":")" + a.type + R"(","port":"COM12","handedness":"right","preset":"defaults",)" +
             R"("device_info":{"major_version":7,"id":")" + a.id + R"(","uuid":"…"},"basis":{"permutation":"XYZ"}},)";
    out += R"("state":{"angular_position":{"a0":-30.9,"a1":53.8,"a2":-6.6},"control_mode":"idle","cursor_position":)" +
           vector("xyz", a.position.data(), 3) + R"(,"cursor_velocity":)" + vector("xyz", a.velocity.data(), 3) +
           R"(,"current_cursor_force":)" + vector("xyz", a.force.data(), 3) + R"(,"transform":)" + identity + "}";
    return out + R"(,"status":{"calibrated":)" + truth(a.calibrated) + R"(,"in_use":)" + truth(a.in_use) +
           R"(,"power_supply":)" + truth(a.power_supply) + R"(,"ready":)" + truth(a.ready) + R"(,"started":true}})";
  }

  std::string message(bool full) const {
    std::string out = R"({"session_id":7,"inverse3":[)";
    bool first = true;
    for (const Arm& a : state_.arms) {
      if (!a.plugged) continue;
      out += (first ? "" : ",") + arm_text(a, full);
      first = false;
    }
    out += "]";
    for (const char* list : {"verse_grip", "wireless_verse_grip"}) {
      out += std::string(",\"") + list + "\":[";
      first = true;
      for (const Grip& g : state_.grips) {
        if (g.list != list) continue;
        out += std::string(first ? "" : ",") + R"({"device_id":")" + g.id + R"(","state":{"orientation":)" +
               vector("wxyz", g.orientation.data(), 4) + R"(,"hall":1,)" + g.buttons + "}}";
        first = false;
      }
      out += "]";
    }
    return out + "}";
  }

  void command(const std::string& text) {
    const bool vector = state_.version >= "3.5";
    const std::string force = vector ? R"("set_cursor_force":{"vector":{)" : R"("set_cursor_force":{"values":{)";
    for (Arm& a : state_.arms) {
      if (text.find(R"("device_id":")" + a.id + "\"") == text.npos) continue;
      ++state_.commands;
      const std::size_t at = text.find(force);
      if (at == text.npos || std::sscanf(text.c_str() + at + force.size(), R"("x":%lf,"y":%lf,"z":%lf)", &a.force[0],
                                         &a.force[1], &a.force[2]) != 3) {
        ++state_.wrong_commands;
        continue;
      }
      a.commanded = std::chrono::steady_clock::now();
      for (const double f : a.force) state_.most_force = std::max(state_.most_force, std::abs(f));
    }
  }

  void serve(Peer& peer) {
    const std::string head = peer.read_until("\r\n\r\n");
    if (head.starts_with("GET /version ")) {
      const std::string body = with([&](State& s) {
        return R"({"build_time":"2024-08-07T16:01:53Z","git_branch":"main","project_name":")" + s.project +
               R"(","project_version":")" + s.version + "\"}";
      });
      return peer.send("HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: " +
                       std::to_string(body.size()) + "\r\n\r\n" + body);
    }
    peer.send(upgrade_answer(head));
    peer.send(server_frame(with([&](State& s) {
      ++s.connections;
      return s.inventory.empty() ? message(true) : s.inventory;
    })));
    ClientFrames frames;
    for (int n = 1; peer.alive;) {
      frames.add(peer.read());
      while (const auto frame = frames.next()) {
        if (frame->opcode == 8) return;
        if (frame->opcode != 1) continue;
        answer(peer, frame->payload, n++);
      }
    }
  }

  void answer(Peer& peer, const std::string& text, int n) {
    std::chrono::microseconds delay{0};
    const std::string out = with([&](State& s) {
      command(text);
      if (n % s.late_every == 0) delay = s.delay;
      if (s.lose_every > 0 && n % s.lose_every == 0) return std::string();
      return s.nonsense.empty() ? message(false) : s.nonsense;
    });
    if (delay.count() > 0) std::this_thread::sleep_for(delay);
    if (!out.empty()) peer.send(server_frame(out));
  }

  std::mutex mutex_;
  State state_;
  std::uint16_t port_ = 0;
  std::unique_ptr<LoopbackServer> server_;  // last: its threads use the others
};

}  // namespace riffler::test

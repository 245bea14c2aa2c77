// The cable between a simulated pen and its host: USB frames of one millisecond, and their faults.
#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <span>
#include <vector>

namespace riffler::pen {

/// Fractions of reports, 0 to 1, drawn independently from a seeded generator: the same every time.
struct CableSettings {
  std::int64_t latency_us = 125;  ///< µs from the end of a report's frame to its arrival
  std::int64_t jitter_us = 0;     ///< µs: largest additional delay
  double lost = 0, doubled = 0;   ///< fractions of reports to the host lost or doubled
  double merged = 0;              ///< fraction held back and read together with the next
  double lost_out = 0;            ///< fraction of reports to the pen lost
  std::uint64_t seed = 1;

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

struct CableCounts {
  std::uint64_t sent = 0, lost = 0, doubled = 0, merged = 0, overrun = 0;
  std::uint64_t sent_out = 0, lost_out = 0;
};

class SimulatedCable {
 public:
  using Report = std::vector<std::uint8_t>;

  explicit SimulatedCable(const CableSettings& settings);
  void set(const CableSettings& settings);

  // The pen's end.

  /// Offers a report. The endpoint holds one: a newer one replaces it.
  void offer(std::span<const std::uint8_t> report) { waiting_.assign(report.begin(), report.end()); }
  /// Takes the oldest report of the host and returns its size; 0 if there is none. Copies at most `bytes.size()` bytes.
  std::size_t receive(std::span<std::uint8_t> bytes);
  /// Simulates the frame that ends at this time.
  void frame(std::int64_t now_us);

  // The host's end.

  /// Sends a report with the next frame.
  void write(std::span<const std::uint8_t> report) { written_.emplace_back(report.begin(), report.end()); }
  /// Reads the oldest report that has arrived by now and returns its size; 0 if there is none. Like a kernel's queue,
  /// it holds the newest 64.
  std::size_t read(std::int64_t now_us, std::span<std::uint8_t> bytes);
  /// Earliest time at which a read may return something.
  std::int64_t arrival_us(std::int64_t next_frame_us) const;

  /// Drops everything in transit.
  void clear();
  const CableCounts& counts() const { return counts_; }

 private:
  struct Arrival {
    std::int64_t time_us;
    Report bytes;
  };
  double draw();
  void arrive(std::int64_t now_us, Report report);

  CableSettings settings_;
  CableCounts counts_;
  std::mt19937_64 random_;
  Report waiting_, held_;               // at the endpoint; to be merged with the next
  std::deque<Arrival> arrivals_;        // in order of time
  std::deque<Report> written_, taken_;  // written by the host; arrived at the pen
};

}  // namespace riffler::pen

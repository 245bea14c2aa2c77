// The cable between a simulated pen and its host: USB's frames of a millisecond, and what goes wrong in them.
#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <span>
#include <vector>

namespace riffler::pen {

/// Shares are of reports, 0 to 1, drawn one by one from a generator with the seed: the same every time.
struct CableSettings {
  std::int64_t latency_us = 125;  ///< from the end of a report's frame to where it is read
  std::int64_t jitter_us = 0;     ///< up to so much more
  double lost = 0, doubled = 0;   ///< on the way to the host
  double merged = 0;              ///< held back, and read together with the next
  double lost_out = 0;            ///< on the way to the pen
  std::uint64_t seed = 1;

  /// std::invalid_argument naming the field.
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
  /// The endpoint holds one report: a newer one takes its place.
  void offer(std::span<const std::uint8_t> report) { waiting_.assign(report.begin(), report.end()); }
  /// Takes the oldest report of the host; 0 where none is there. At most `bytes.size()` are copied, the whole size is
  /// the answer.
  std::size_t receive(std::span<std::uint8_t> bytes);
  /// What happens in the frame that ends at this time.
  void frame(std::int64_t now_us);

  // The host's end.
  /// Goes with the next frame.
  void write(std::span<const std::uint8_t> report) { written_.emplace_back(report.begin(), report.end()); }
  /// What has arrived by now, oldest first; 0 where nothing has. Like a kernel's queue it holds the newest 64.
  std::size_t read(std::int64_t now_us, std::span<std::uint8_t> bytes);
  /// When the next read may bring something.
  std::int64_t arrival_us(std::int64_t next_frame_us) const;

  /// Nothing is on the way any more.
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
  std::deque<Arrival> arrivals_;        // times do not fall
  std::deque<Report> written_, taken_;  // by the host; of them, those that are at the pen
};

}  // namespace riffler::pen

// How the thread of a device reads it and looks for it again.
#pragma once

namespace riffler::pen {

struct DriverSettings {
  double read_timeout = 0.01;  ///< s without a report after which the step runs all the same, with an old sample
  double silence = 0.25;       ///< s without a report after which a device that has a period counts as gone
  double first_retry = 0.1;    ///< s after which a lost device is looked for; doubled after every failure …
  double longest_retry = 2;    ///< … up to this
  double poll = 0.01;          ///< s between two looks at the connector
  unsigned most_reads = 256;   ///< in one tick: a device that floods cannot hold up the step

  /// std::invalid_argument naming the field.
  void validate() const;
};

}  // namespace riffler::pen

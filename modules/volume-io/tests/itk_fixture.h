#pragma once

#include "samples.h"

#include <gmock/gmock.h>
#include <isolux/volume_io/read.h>

#include <string>

namespace isolux::test {

inline const ReadOptions kSpaced{.raw = {}, .spacing = Vec3(0.5, 2, 4), .allow_external_data = false};

/// Small files of one ramp, read and refused.
class RampFile : public ::testing::Test {
 protected:
  /// The ramp 0, 1, ... 11 on 3x2x2 voxels.
  static void expect_ramp(const Volume& volume, float first = 0.0f) {
    ASSERT_EQ(volume.lattice().size, Index3(3, 2, 2));
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(volume.values.values()[i], first + float(i));
  }
  [[nodiscard]] std::string refused(const std::string& name, const std::string& bytes,
                                    const ReadOptions& options = {}) const {
    std::string message = reading_error(folder_.write(name, bytes), options);
    EXPECT_THAT(message, ::testing::HasSubstr(name)) << "a message names the file";
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  }
  TemporaryFolder folder_;
};

/// Files for ITK; skipped where isolux is built without it.
class Itk : public RampFile {
 protected:
  void SetUp() override {  // NOLINT(readability-identifier-naming): GoogleTest's name
    if (!has_reader("itk")) GTEST_SKIP() << "no ITK in this build";
  }
};

}  // namespace isolux::test

#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using test::kSpaced;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TiffFolder : public test::Itk {
 protected:
  [[nodiscard]] std::vector<std::string> remarks(const std::vector<std::string>& names) const {
    const test::TemporaryFolder pages;
    for (const auto& name : names) (void)pages.write(name, test::tiff_sample(0));
    return read_volume(pages.file("."), kSpaced).remarks;
  }
};

TEST_F(TiffFolder, SaysWhichPageIsMissing) {
  EXPECT_THAT(remarks({"s9.tif", "s10.tif", "s12.tif", "s13.tif", "s14.tif", "s18.tif"}),
              ElementsAre(HasSubstr("a page of the number 11 is missing between s10.tif and s12.tif")));
  EXPECT_THAT(remarks({"s006.tif", "s007.tif", "s008.tif", "s010.tif"}),
              ElementsAre(HasSubstr("the number 009 is missing")));
  EXPECT_THAT(remarks({"b1_10.tif", "b1_20.tif", "b1_40.tif", "b1_50.tif"}),
              ElementsAre(HasSubstr("the number 30 is missing")));
  EXPECT_THAT(remarks({"8.tif", "10.tif", "11.tif", "12.tif"}), ElementsAre(HasSubstr("the number 9 is missing")));
}

TEST_F(TiffFolder, SaysNothingOfNamesThatCountNoPages) {
  for (const std::vector<std::string>& names :
       std::vector<std::vector<std::string>>{{"s8.tif", "s9.tif", "s10.tif"},
                                             {"s1.tif", "s3.tif"},
                                             {"s1.tif", "s3.tif", "s5.tif"},
                                             {"a.tif", "b.tif", "d.tif"},
                                             {"z1_t1.tif", "z1_t2.tif", "z2_t1.tif", "z2_t4.tif"},
                                             {"121500.tif", "121507.tif", "121511.tif"},
                                             {"121500.tif", "121507.tif", "121511.tif", "121530.tif"},
                                             {"0.tif", "4.tif", "8.tif", "12.tif", "22.tif"},
                                             {"0.tif", "1.tif", "2.tif", "4.tif", "6.tif"},
                                             {"8.tif", "10.tif", "11.tif"},
                                             {"s1.tif", "s2.tif", "s99999999999999999999999.tif"}})
    EXPECT_THAT(remarks(names), IsEmpty()) << names.back();
}

}  // namespace
}  // namespace isolux

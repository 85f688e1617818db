#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using test::Itk;
using test::kSpaced;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The sample with an ImageDescription, and one further page or none.
std::string described(std::string text, bool two = true) {
  text.resize(text.size() / 2 * 2 + 2, '\0');
  const std::string sample = test::tiff_sample(0);
  const std::size_t data = 8 + 2 + 10 * 12 + 4;
  std::string page = sample.substr(0, 10 + 5 * 12) + test::bytes_of<std::uint16_t>({270, 2}) +
                     test::bytes_of<std::uint32_t>({std::uint32_t(text.size()), std::uint32_t(data + 12)}) +
                     sample.substr(10 + 5 * 12);
  test::put<std::uint16_t>(page, 8, 10);
  test::put<std::uint32_t>(page, 10 + 6 * 12 + 8, std::uint32_t(data));
  page += text;
  return two ? test::two_pages(page, test::tiff_sample(6)) : page;
}

std::string ome(const std::string& sizes, const std::string& more = {}) {
  return R"(<?xml version="1.0"?><OME xmlns="http://x"><Image ID="Image:0"><Pixels ID="Pixels:0" PhysicalSizeZ="3" )" +
         sizes + R"( SizeX="3" SizeY="2"><Channel ID="Channel:0:0" SizeC="9"/></Pixels></Image>)" + more + "</OME>";
}

TEST_F(Itk, RefusesHyperstacksInTiff) {
  const auto message = [&](const std::string& text) { return refused("a.tif", described(text), kSpaced); };
  EXPECT_THAT(message("ImageJ=1.53t\nimages=2\nchannels=3\nslices=4\nframes=2\nhyperstack=true\n"),
              HasSubstr("ImageJ says channels: 3, sections: 4, frames: 2: a volume is the sections of one channel"));
  EXPECT_THAT(message("ImageJ=1.53t\r\nframes=2\r\nslices=4\r\n"), HasSubstr("channels: 1, sections: 4, frames: 2"));
  EXPECT_THAT(message(ome(R"(SizeC="2" SizeZ="4" SizeT="1")")),
              HasSubstr("OME says channels: 2, sections: 4, frames: 1"));
  EXPECT_THAT(message(ome("SizeT = '5'\nSizeC='2'")), HasSubstr("OME says channels: 2, sections: 1, frames: 5"));
}

// As the program tifffile writes volumes of which it is not told what their axes are.
TEST_F(Itk, ReadsTiffPagesByAnotherNameAsSectionsAndSaysSo) {
  const auto remark = [&](const std::string& text) {
    const Volume volume = read_volume(folder_.write("a.tif", described(text)), kSpaced);
    expect_ramp(volume);
    return volume.remarks;
  };
  EXPECT_THAT(remark("ImageJ=1.11a\nimages=2\nchannels=2\nhyperstack=true\nmode=grayscale"),
              ElementsAre(HasSubstr("a.tif: ImageJ says that its pages are channels: they are taken as sections")));
  EXPECT_THAT(remark("ImageJ=1.11a\nimages=2\nframes=2\n"), ElementsAre(HasSubstr("its pages are frames")));
  EXPECT_THAT(remark(ome(R"(SizeC="1" SizeZ="1" SizeT="2")")), ElementsAre(HasSubstr("OME says that its pages are")));
  for (const std::string& text :
       {std::string("ImageJ=1.11a\nimages=2\nslices=2\nspacing=3\nunit=micron\n"), ome(R"(SizeC="1" SizeZ="2")"),
        std::string("channels=2\nslices=2\n"), std::string("ImageJ=1\nimages=\nchannels=x\n"), std::string("<OME/>")})
    EXPECT_THAT(remark(text), IsEmpty()) << text;
}

// Above 4 GB ImageJ writes all images behind the one that has a page.
TEST_F(Itk, RefusesTiffOfWhichImagejHasLeftOutPages) {
  EXPECT_THAT(refused("a.tif", described("ImageJ=1.53t\nimages=4\nslices=4\n", false), kSpaced),
              HasSubstr("ImageJ says images=4, of which 1 have TIFF pages"));
  EXPECT_EQ(test::reading_error(folder_.write("a.tif", described("ImageJ=1.53t\nimages=2\n")), kSpaced), "");
}

TEST_F(Itk, RefusesSeveralImagesOfOmeInTiff) {
  const std::string image = R"(<Image><Pixels SizeC="1" SizeZ="1" SizeT="1"/></Image>)";
  EXPECT_THAT(refused("a.tif", described(ome(R"(SizeC="1" SizeZ="1" SizeT="1")", image)), kSpaced),
              HasSubstr("OME says several images, the first of 1 sections"));
  EXPECT_EQ(test::reading_error(folder_.write("a.tif", described(ome(R"(SizeZ="2")", image))), kSpaced), "")
      << "the others are elsewhere";
}

TEST_F(Itk, ReadsOmeThatNamesPixelsInItsText) {
  const std::string two = R"(SizeC="1" SizeZ="2" SizeT="1")";
  const auto named = [&](const std::string& before) { return ome(two).insert(ome(two).find("<Image"), before); };
  for (const std::string& text :
       {named(R"(<Image Name="Pixels 2020"/>)"), named("<Description>320 Pixels wide</Description>"),
        named("<!-- <Pixels SizeC=\"2\"> -->"), named("<PixelsOfOthers SizeC=\"2\"/>"),
        ome(two, "<Description>320 Pixels wide</Description>")}) {
    const Volume volume = read_volume(folder_.write("a.tif", described(text)), kSpaced);
    expect_ramp(volume);
    EXPECT_THAT(volume.remarks, IsEmpty()) << text;
  }
  const std::string one = R"(SizeC="1" SizeZ="1" SizeT="1")";
  EXPECT_EQ(test::reading_error(folder_.write("a.tif", described(ome(one, "<Text>Pixels of 1</Text>"))), kSpaced), "");
}

TEST_F(Itk, ReadsTagsOfOmeHoweverXmlWritesThem) {
  const std::string sizes = R"(SizeC="2" SizeZ="4" SizeT="1"/></Image></OME>)";
  for (const std::string head :
       {"<OME>\n<Image>\n<Pixels\n", "<OME\n><Image><Pixels\t", "<OME><Image><Pixels\r\nID='a'\r\n",
        "<ome:OME xmlns:ome='http://x'><ome:Image><ome:Pixels ", "<o:OME><o:Image><o:Pixels\n"})
    EXPECT_THAT(refused("a.tif", described(head + sizes), kSpaced), HasSubstr("OME says channels: 2, sections: 4"))
        << head;
  const std::string image = "<ome:Image><ome:Pixels\nSizeC='1'\nSizeZ='1'\nSizeT='1'/></ome:Image>";
  EXPECT_THAT(refused("a.tif", described("<ome:OME>" + image + image + "</ome:OME>"), kSpaced),
              HasSubstr("OME says several images, the first of 1 sections"));
  EXPECT_EQ(test::reading_error(folder_.write("a.tif", described("<OMEGA><Pixels SizeC='2' SizeZ='4'/>")), kSpaced),
            "");
}

TEST_F(Itk, RefusesTiffDescriptionsThatAreLongerThanTheFile) {
  std::string bytes = described("ImageJ=1.53t\nimages=2\n");
  test::put<std::uint32_t>(bytes, 10 + 5 * 12 + 4, 4000000000u);
  EXPECT_THAT(refused("a.tif", bytes, kSpaced), HasSubstr("the file has"));
}

}  // namespace
}  // namespace isolux

// The page of `dapple converge` as a person meets it: opened from the disk in a browser, clicked through, looked at.
//
// DAPPLE_SCREENSHOTS names a folder that gets photographs; without it they are only looked at by the test.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "src/image/image_io.h"
#include "tests/app/program.h"
#include "tests/browser/browser.h"

namespace dapple {
namespace {

using testing_support::Browser;
using testing_support::Point;
using Json = nlohmann::json;

class Report : public ProgramTest {
 protected:
  /// One page and one browser for all tests of the program: the first that needs them makes them.
  struct Shared {
    std::string page, data, profile;
    std::unique_ptr<Browser> browser;
  };
  static std::unique_ptr<Shared> shared;

  static void TearDownTestSuite() {
    if (!shared) return;
    const std::string profile = shared->profile;
    shared.reset();  // the browser must be gone before its profile is
    std::error_code ignored;
    std::filesystem::remove_all(profile, ignored);
  }

  void SetUp() override {
    const std::string chromium = testing_support::FindChromium();
    if (chromium.empty()) GTEST_SKIP() << "no chromium here: scripts/install_packages.sh chromium could not install it";
    if (!shared) {
      ASSERT_NO_FATAL_FAILURE(MakeReport(chromium));
    }
    Write("index.html", shared->page);
    data_ = Json::parse(shared->data);
    browser_ = shared->browser.get();
    browser_->SetSize(1280, 900);
    browser_->PreferScheme("light");
    browser_->Open("file://" + Path("index.html"));
  }

  void MakeReport(const std::string& chromium) {
    WriteScene("tiny.pbrt");
    Write("other.pbrt", Read("tiny.pbrt") + "LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.5]\n");
    const ProgramResult result = Run(
        "converge tiny.pbrt other.pbrt --integrators path,sppm,light_tracing --time 0.4 --seeds 2 --reference-time 0.5 "
        "--resolution 60x40 --photons 2000 --no-guide -o out --quiet");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    auto made = std::make_unique<Shared>();
    made->page = Read("out/index.html");
    made->data = Read("out/data.json");
    made->profile = testing::TempDir() + "dapple_browser_" + std::to_string(getpid());
    made->browser = std::make_unique<Browser>(chromium, made->profile, 1280, 900);
    shared = std::move(made);
  }

  void TearDown() override {
    if (!browser_) return;
    EXPECT_EQ(browser_->TakeComplaints(), std::vector<std::string>());
    for (const std::string& url : browser_->TakeRequests())
      EXPECT_TRUE(url == "file://" + Path("index.html") || url.starts_with("data:")) << url.substr(0, 100);
  }

  Json Ask(const std::string& expression) { return browser_->Evaluate(expression); }
  std::string Text(const std::string& selector) {
    return Ask("document.querySelector(" + Json(selector).dump() + ").textContent");
  }
  bool IsTrue(const std::string& expression) { return Ask(expression).get<bool>(); }
  int Count(const std::string& selector) {
    return Ask("document.querySelectorAll(" + Json(selector).dump() + ").length");
  }
  /// Of all images that are shown.
  std::vector<std::string> ImageStyles(const std::string& property) {
    return Ask("[...document.querySelectorAll('.view img')].map((i) => i.style." + property + ")");
  }
  /// The picture of the window; kept under that name where somebody wants to see it.
  Image Photograph(const std::string& name, bool isWholePage = false) {
    const std::string png = browser_->Screenshot(isWholePage);
    Write("shot.png", png);
    if (const char* folder = std::getenv("DAPPLE_SCREENSHOTS"))
      std::ofstream(std::string(folder) + "/" + name + ".png", std::ios::binary) << png;
    return ReadImage(Path("shot.png"));
  }
  static float MeanLuminance(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.Height(); ++y)
      for (int x = 0; x < image.Width(); ++x) sum += double{image.ColorAt(x, y).Luminance()};
    return static_cast<float>(sum / (image.Width() * image.Height()));
  }

  const Json& Scene() const { return data_["scenes"][0]; }

  Json data_;
  Browser* browser_ = nullptr;
};

std::unique_ptr<Report::Shared> Report::shared;

TEST_F(Report, ShowsWhatWasMeasured) {
  EXPECT_EQ(Text("#title"), "tiny");
  EXPECT_TRUE(Contains(Text("#summary"), "60 × 40 pixels"));
  EXPECT_EQ(Text("#command"), data_["about"]["commandLine"]);
  EXPECT_TRUE(Contains(Text("#facts"), "Dapple " + std::string(data_["about"]["version"])));
  EXPECT_TRUE(Contains(Text("#facts"), data_["about"]["processor"]));
  for (const char* plot : {"#plot-time", "#plot-passes"}) {
    for (const auto& contender : Scene()["contenders"]) {
      const std::string series = std::string(plot) + " [data-name=\"" + std::string(contender["name"]) + "\"]";
      EXPECT_EQ(Count(series + " .curve"), 1);
      EXPECT_EQ(Count(series + " .mark"), static_cast<int>(contender["curve"].size()));
    }
    EXPECT_TRUE(Contains(Text(plot), "the reference’s own error"));
  }
  EXPECT_EQ(Count("#table tbody tr"), 3);
  EXPECT_EQ(Count("#table .best"), 1);
  EXPECT_EQ(Count("#scoreboard tbody tr"), 3) << "two scenes and the mean";
  EXPECT_EQ(Count(".view img"), 4) << "the reference and three contenders";
  EXPECT_TRUE(
      IsTrue("[...document.images].every((i) => i.complete && i.naturalWidth === 60 && i.naturalHeight === 40)"));
  const Image shot = Photograph("light", true);
  EXPECT_GT(shot.Height(), 1200);
  std::set<std::array<float, 3>> colors;
  for (int y = 0; y < shot.Height(); y += 3)
    for (int x = 0; x < shot.Width(); x += 3) colors.insert({shot.At(x, y, 0), shot.At(x, y, 1), shot.At(x, y, 2)});
  EXPECT_GT(colors.size(), 200u) << "plots and pictures are painted";
}

// Marks lie where their values say: heights are logarithms of errors, along one scale.
TEST_F(Report, CurvesLieOnLogarithmicAxes) {
  const auto& curve = Scene()["contenders"][0]["curve"];
  ASSERT_GE(curve.size(), 3u);
  const Json places =
      Ask("[...document.querySelectorAll('#plot-time [data-name=\"path\"] .mark')].map((m) => m.getCTM()).map((m) => "
          "[m.e, m.f])");
  ASSERT_EQ(places.size(), curve.size());
  const auto logOf = [&](size_t i, int axis) {
    return std::log((axis == 0 ? curve[i]["seconds"] : curve[i]["mean"]["relativeMse"]).get<double>());
  };
  const size_t last = curve.size() - 1;
  for (const int axis : {0, 1}) {
    const double unit =
        (places[last][axis].get<double>() - places[0][axis].get<double>()) / (logOf(last, axis) - logOf(0, axis));
    EXPECT_LT(axis == 0 ? -unit : unit, 0) << "time to the right, error upward";
    for (size_t i = 0; i <= last; ++i)
      EXPECT_NEAR(places[i][axis].get<double>(),
                  places[0][axis].get<double>() + unit * (logOf(i, axis) - logOf(0, axis)), 0.05);
  }
}

TEST_F(Report, MeasuresAndAlgorithmsAreSwitched) {
  const std::string before = Text("#table");
  browser_->Click("#measures [data-value=flip]");
  EXPECT_EQ(Ask("document.querySelector('#measures [data-value=flip]').getAttribute('aria-pressed')"), "true");
  EXPECT_EQ(Ask("document.querySelector('#plot-time svg').getAttribute('aria-label')"), "FLIP against seconds");
  EXPECT_NE(Text("#table"), before);
  EXPECT_TRUE(Contains(Text("#definition"), "HDR-FLIP"));
  browser_->Click("#legend [data-name=path]");
  EXPECT_EQ(Count("[data-name=path] .curve"), 0);
  EXPECT_EQ(Count("[data-name=sppm] .curve"), 2);
  EXPECT_EQ(Count(".view img"), 3);
  browser_->Click("#legend [data-name=path]");
  EXPECT_EQ(Count("[data-name=path] .curve"), 2);
}

TEST_F(Report, HoveringTellsTheValues) {
  EXPECT_TRUE(IsTrue("document.getElementById('tip').hidden"));
  browser_->MoveTo(browser_->Find("#plot-passes [data-name=sppm] .mark:last-of-type"));
  EXPECT_FALSE(IsTrue("document.getElementById('tip').hidden"));
  EXPECT_TRUE(BeginsWith(Text("#tip"), "sppm"));
  EXPECT_TRUE(Contains(Text("#tip"), "of 2 seeds"));
  EXPECT_EQ(Count(".mark.is-near"), 1);
  Photograph("hover");
  browser_->MoveTo(browser_->Find("#title"));
  EXPECT_TRUE(IsTrue("document.getElementById('tip').hidden"));
}

TEST_F(Report, AllImagesMoveTogether) {
  browser_->Click("#zoom-in");
  browser_->Click("#zoom-in");
  const auto zoomed = ImageStyles("transform");
  EXPECT_EQ(zoomed[0], "translate(-150%, -150%) scale(4)");
  EXPECT_EQ(std::ranges::count(zoomed, zoomed[0]), 4);
  const Point image = browser_->Find(".view");
  browser_->Drag(image, {image.x + 40, image.y + 20});
  const auto dragged = ImageStyles("transform");
  EXPECT_NE(dragged[0], zoomed[0]);
  EXPECT_EQ(std::ranges::count(dragged, dragged[0]), 4);
  browser_->Wheel(image, -200);
  EXPECT_GT(Ask("state.view.zoom").get<double>(), 4);
  Photograph("zoomed");
  browser_->ClickAt(image, 2);
  EXPECT_EQ(ImageStyles("transform")[3], "translate(0%, 0%) scale(1)");
}

TEST_F(Report, TheSliderDividesTwoImages) {
  browser_->Click("#layout [data-value=pair]");
  EXPECT_EQ(Count(".view"), 1);
  EXPECT_EQ(Count(".view img"), 2);
  const auto clip = ImageStyles("clipPath");
  EXPECT_EQ(clip[0], "inset(0px 50% 0px 0px)");
  browser_->Click("#divider");
  for (int i = 0; i < 20; ++i) browser_->PressKey("ArrowRight");
  EXPECT_NE(ImageStyles("clipPath")[0], clip[0]);
  Ask("(() => { const s = document.getElementById('right'); s.value = 'light_tracing'; s.dispatchEvent(new "
      "Event('change')); })()");
  EXPECT_TRUE(Contains(Text(".pane figcaption"), "reference | light_tracing"));
  const Point middle = browser_->Find(".view");
  browser_->MoveTo({middle.x, middle.y});
  EXPECT_NEAR(Ask("Number(document.getElementById('divider').value)").get<double>(), 50, 0.5);
  Photograph("slider");
}

TEST_F(Report, DifferencesAndEarlierMomentsAreShown) {
  const Json pictures = Ask("[...document.querySelectorAll('.view img')].map((i) => i.src.length + i.src.slice(-60))");
  browser_->Click("#content [data-value=difference]");
  const Json differences =
      Ask("[...document.querySelectorAll('.view img')].map((i) => i.src.length + i.src.slice(-60))");
  EXPECT_EQ(differences[0], pictures[0]) << "the reference stays";
  for (const size_t i : {1, 2, 3}) EXPECT_NE(differences[i], pictures[i]);
  EXPECT_FALSE(IsTrue("document.getElementById('scale').hidden"));
  Photograph("differences");
  browser_->Click("#content [data-value=picture]");
  const std::string last = Text("#moment-text");
  browser_->Click("#moment");
  browser_->PressKey("Home");
  EXPECT_NE(Text("#moment-text"), last);
}

TEST_F(Report, LightAndDarkFollowTheSystemAndTheButton) {
  const float light = MeanLuminance(Photograph("theme-light"));
  EXPECT_GT(light, 0.4f);
  browser_->PreferScheme("dark");
  EXPECT_LT(MeanLuminance(Photograph("dark", true)), 0.15f);
  browser_->PreferScheme("light");
  EXPECT_NEAR(MeanLuminance(Photograph("theme-light")), light, 0.01f);
  browser_->Click("#theme");
  EXPECT_LT(MeanLuminance(Photograph("theme-button")), 0.15f);
}

TEST_F(Report, ScenesAreChosen) {
  browser_->Click("#scenes [data-value=\"1\"]");
  EXPECT_EQ(Text("#title"), "other");
  browser_->Click("#scoreboard tbody tr:first-child td");
  EXPECT_EQ(Text("#title"), "tiny");
}

TEST_F(Report, NothingIsWiderThanASmallScreen) {
  browser_->SetSize(390, 800);
  browser_->Open("file://" + Path("index.html"));
  Photograph("narrow", true);
  EXPECT_LE(Ask("document.scrollingElement.scrollWidth").get<int>(), 390);
  EXPECT_EQ(Count("#plot-time .curve"), 3);
}

}  // namespace
}  // namespace dapple

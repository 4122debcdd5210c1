// Refines one case with OpenSubdiv and prints every level: the reference for our crease and boundary rules.
// README.md describes the input and the output.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace far = OpenSubdiv::Far;
namespace sdc = OpenSubdiv::Sdc;

struct Point {
    double x = 0, y = 0, z = 0;

    // The interface that PrimvarRefiner needs.
    void Clear(void* = nullptr) { x = y = z = 0; }
    void AddWithWeight(const Point& p, double w) { x += w * p.x; y += w * p.y; z += w * p.z; }
};

// The reason why a case is refused.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Case {
    sdc::SchemeType scheme = sdc::SCHEME_CATMARK;
    sdc::Options options;
    int levels = 1;
    bool limit = false;
    std::vector<Point> positions;
    std::vector<int> degrees, corners;      // face by face
    std::vector<int> crease_ends, corner_vertices; // two ends per edge; one vertex per corner
    std::vector<float> crease_sharpness, corner_sharpness;
};

// --- reading

static float sharpness(const std::string& word) {
    char* end = nullptr;
    double s = std::strtod(word.c_str(), &end); // reads inf too
    if (word.empty() || *end || std::isnan(s) || s < 0) throw Refusal("sharpness '" + word + "'");
    return s >= sdc::Crease::SHARPNESS_INFINITE ? sdc::Crease::SHARPNESS_INFINITE : float(s);
}

template <class T> static T choose(const std::string& word, std::vector<std::pair<const char*, T>> choices) {
    for (auto& [name, value] : choices)
        if (word == name) return value;
    throw Refusal("unknown choice '" + word + "'");
}

static void read_line(Case& c, const std::string& keyword, std::istringstream& words) {
    using O = sdc::Options;
    std::string word;
    auto integer = [&] {
        int i = 0;
        if (!(words >> i)) throw Refusal("'" + keyword + "' lacks a number");
        return i;
    };
    if (keyword == "scheme") {
        words >> word;
        c.scheme = choose<sdc::SchemeType>(word, {{"catmull-clark", sdc::SCHEME_CATMARK}, {"loop", sdc::SCHEME_LOOP}});
    } else if (keyword == "boundary") {
        words >> word;
        c.options.SetVtxBoundaryInterpolation(choose<O::VtxBoundaryInterpolation>(word,
            {{"none", O::VTX_BOUNDARY_NONE}, {"edge-only", O::VTX_BOUNDARY_EDGE_ONLY},
             {"edge-and-corner", O::VTX_BOUNDARY_EDGE_AND_CORNER}}));
    } else if (keyword == "creasing") {
        words >> word;
        c.options.SetCreasingMethod(choose<O::CreasingMethod>(word, {{"uniform", O::CREASE_UNIFORM}, {"chaikin", O::CREASE_CHAIKIN}}));
    } else if (keyword == "levels") {
        c.levels = integer();
        if (c.levels < 0 || c.levels > 10) throw Refusal("levels must be 0 to 10");
    } else if (keyword == "limit") {
        c.limit = true;
    } else if (keyword == "v") {
        Point p;
        if (!(words >> p.x >> p.y >> p.z)) throw Refusal("'v' lacks a coordinate");
        c.positions.push_back(p);
    } else if (keyword == "f") {
        int degree = 0;
        for (int i; words >> i; ++degree) c.corners.push_back(i);
        if (words.eof()) words.clear(); // the end of the line, not a bad word
        c.degrees.push_back(degree);
    } else if (keyword == "edge") {
        for (int i = 0; i < 2; ++i) c.crease_ends.push_back(integer());
        words >> word;
        c.crease_sharpness.push_back(sharpness(word));
    } else if (keyword == "corner") {
        c.corner_vertices.push_back(integer());
        words >> word;
        c.corner_sharpness.push_back(sharpness(word));
    } else {
        throw Refusal("unknown keyword '" + keyword + "'");
    }
    std::string rest;
    if (words.fail() || words >> rest) throw Refusal("'" + keyword + "' has a wrong or an extra word");
}

// Refuses cases in which OpenSubdiv would read out of bounds.
static void check(const Case& c) {
    if (c.degrees.empty()) throw Refusal("no faces");
    for (auto* list : {&c.corners, &c.crease_ends, &c.corner_vertices})
        for (int v : *list)
            if (v < 0 || v >= int(c.positions.size())) throw Refusal("no vertex " + std::to_string(v));
    size_t first = 0;
    for (int degree : c.degrees) {
        if (degree < 3) throw Refusal("a face of " + std::to_string(degree) + " corners");
        for (int i = 0; i < degree; ++i)
            for (int j = 0; j < i; ++j)
                if (c.corners[first + i] == c.corners[first + j]) throw Refusal("a face with one vertex twice");
        first += degree;
    }
}

static Case read_case(std::istream& in) {
    Case c;
    c.options.SetVtxBoundaryInterpolation(sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    for (std::string line, keyword; std::getline(in, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        if (words >> keyword) read_line(c, keyword, words);
    }
    check(c);
    return c;
}

// --- refining

// The first message of OpenSubdiv, which reports to a callback and then continues or returns null.
static std::string first_message;
static void report(const char* message) {
    if (first_message.empty()) first_message = message;
    for (char& letter : first_message)
        if (letter == '\n') letter = ' ';
}

static std::unique_ptr<far::TopologyRefiner> refiner(const Case& c) {
    using Factory = far::TopologyRefinerFactory<far::TopologyDescriptor>;
    far::TopologyDescriptor d;
    d.numVertices = int(c.positions.size());
    d.numFaces = int(c.degrees.size());
    d.numVertsPerFace = c.degrees.data();
    d.vertIndicesPerFace = c.corners.data();
    d.numCreases = int(c.crease_sharpness.size());
    d.creaseVertexIndexPairs = c.crease_ends.data();
    d.creaseWeights = c.crease_sharpness.data();
    d.numCorners = int(c.corner_vertices.size());
    d.cornerVertexIndices = c.corner_vertices.data();
    d.cornerWeights = c.corner_sharpness.data();
    Factory::Options options(c.scheme, c.options);
    options.validateFullTopology = true;
    std::unique_ptr<far::TopologyRefiner> r(Factory::Create(d, options));
    if (!r) throw Refusal(first_message.empty() ? "topology" : first_message);
    if (!first_message.empty()) throw Refusal(first_message);
    far::TopologyRefiner::UniformOptions uniform(c.levels);
    uniform.fullTopologyInLastLevel = true;
    if (c.levels > 0) r->RefineUniform(uniform);
    return r;
}

// --- printing

static const char* rule_name(sdc::Crease::Rule rule) {
    switch (rule) {
        case sdc::Crease::RULE_SMOOTH: return "smooth";
        case sdc::Crease::RULE_DART: return "dart";
        case sdc::Crease::RULE_CREASE: return "crease";
        case sdc::Crease::RULE_CORNER: return "corner";
        default: return "unknown";
    }
}

// Returns the origin of each vertex of a level: "vertex 3", "edge 0 1" or "face 2" of the level above.
static std::vector<std::string> origins(const far::TopologyRefiner& r, int level) {
    std::vector<std::string> names(r.GetLevel(level).GetNumVertices());
    if (level == 0) {
        for (size_t v = 0; v < names.size(); ++v) names[v] = "given " + std::to_string(v);
        return names;
    }
    auto& above = r.GetLevel(level - 1);
    auto name = [&](int child, const std::string& text) { if (child >= 0) names[child] = text; };
    for (int v = 0; v < above.GetNumVertices(); ++v) name(above.GetVertexChildVertex(v), "vertex " + std::to_string(v));
    for (int e = 0; e < above.GetNumEdges(); ++e) {
        auto ends = above.GetEdgeVertices(e);
        name(above.GetEdgeChildVertex(e), "edge " + std::to_string(ends[0]) + " " + std::to_string(ends[1]));
    }
    if (r.GetSchemeType() == sdc::SCHEME_CATMARK)
        for (int f = 0; f < above.GetNumFaces(); ++f) name(above.GetFaceChildVertex(f), "face " + std::to_string(f));
    return names;
}

static void print_level(const far::TopologyRefiner& r, int level, const std::vector<Point>& positions) {
    auto& l = r.GetLevel(level);
    auto names = origins(r, level);
    std::printf("level %d\n", level);
    for (int v = 0; v < l.GetNumVertices(); ++v) {
        auto& p = positions[v];
        std::printf("v %.9g %.9g %.9g %s %s\n", p.x, p.y, p.z, rule_name(l.GetVertexRule(v)), names[v].c_str());
    }
    for (int f = 0; f < l.GetNumFaces(); ++f) {
        std::printf(l.IsFaceHole(f) ? "hole" : "f");
        auto corners = l.GetFaceVertices(f);
        for (int i = 0; i < corners.size(); ++i) std::printf(" %d", corners[i]);
        std::printf("\n");
    }
    for (int e = 0; e < l.GetNumEdges(); ++e)
        if (l.GetEdgeSharpness(e) > 0) {
            auto ends = l.GetEdgeVertices(e);
            std::printf("edge %d %d %.9g\n", ends[0], ends[1], l.GetEdgeSharpness(e));
        }
    for (int v = 0; v < l.GetNumVertices(); ++v)
        if (l.GetVertexSharpness(v) > 0) std::printf("corner %d %.9g\n", v, l.GetVertexSharpness(v));
}

static void print_limit(const far::PrimvarRefinerReal<double>& primvars, const std::vector<Point>& last) {
    std::vector<Point> limit(last.size()), first(last.size()), second(last.size());
    primvars.Limit(last, limit, first, second);
    std::printf("limit\n");
    for (size_t v = 0; v < last.size(); ++v) {
        std::printf("p");
        for (auto& p : {limit[v], first[v], second[v]}) std::printf(" %.9g %.9g %.9g", p.x, p.y, p.z);
        std::printf("\n");
    }
}

static void refine(const Case& c) {
    auto r = refiner(c);
    far::PrimvarRefinerReal<double> primvars(*r);
    std::vector<Point> positions = c.positions;
    print_level(*r, 0, positions);
    for (int level = 1; level <= c.levels; ++level) {
        std::vector<Point> finer(r->GetLevel(level).GetNumVertices());
        primvars.Interpolate(level, positions, finer);
        positions.swap(finer);
        print_level(*r, level, positions);
    }
    if (c.limit) print_limit(primvars, positions);
}

int main() {
    far::SetErrorCallback([](far::ErrorType, const char* message) { report(message); });
    far::SetWarningCallback([](const char* message) { report(message); });
    try {
        refine(read_case(std::cin));
    } catch (const Refusal& why) {
        std::printf("refused: %s\n", why.what());
    }
}

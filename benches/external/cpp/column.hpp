// Runs a library as a column of `sixfold study`. An adapter implements the queries with the library; this
// header implements the protocol and the operations. ../README.md describes both; ../rust/column is the
// same in Rust.
//
// An adapter has
//   Vertex, Edge, Face                    handles, cheap to copy
//   library()                             its name and version
//   Adapter(const Input&)                 builds, or throws std::runtime_error with the reason
//   each_vertex(f), each_edge(f), each_face(f)
//   index(v), index(e), index(f)          numbers; for vertices and faces those of the input
//   face(i)                               the face with that number
//   vertex_vertices(v, f) … face_faces(x, f), except edge_edges, which is computed from the others
//   edge_ends(e)                          a pair of vertices
//   position(v), set_position(v, p)
#pragma once

#include <cmath>
#include <cstdint>
#include <ctime>
#include <deque>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <nlohmann/json.hpp>

namespace column {

struct Vector {
    float x = 0, y = 0, z = 0;
};
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(Vector a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float length(Vector a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
inline Vector cross(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The mesh as flat arrays, as Sixfold writes it for its columns.
struct Input {
    std::vector<Vector> positions;
    std::vector<int> corners;
    std::vector<int> starts{0};

    int faces() const { return int(starts.size()) - 1; }

    explicit Input(const std::string& path) {
        std::ifstream file(path);
        if (!file) throw std::runtime_error(path + " cannot be read");
        std::string line, kind;
        while (std::getline(file, line)) {
            std::istringstream words(line);
            words >> kind;
            if (kind == "v") {
                Vector p;
                if (!(words >> p.x >> p.y >> p.z)) throw std::runtime_error("not a vertex: " + line);
                positions.push_back(p);
            } else if (kind == "f") {
                for (int corner; words >> corner;) {
                    if (corner < 1 || corner > int(positions.size())) throw std::runtime_error("not a face: " + line);
                    corners.push_back(corner - 1);
                }
                starts.push_back(int(corners.size()));
            }
        }
    }
};

struct RunResult {
    double checksum;
    uint64_t elements;
};

// The sum of handle numbers. It is not used, but because it is volatile the compiler cannot omit it.
inline volatile uint64_t sink;

inline uint64_t nanoseconds(clockid_t clock) {
    timespec now;
    clock_gettime(clock, &now);
    return uint64_t(now.tv_sec) * 1000000000 + uint64_t(now.tv_nsec);
}

// Returns the bytes that the program has allocated; 0 if the allocator does not say it.
inline size_t allocated() {
#ifdef __GLIBC__
    const struct mallinfo2 now = mallinfo2();
    return now.uordblks + now.hblkhd;
#else
    return 0;
#endif
}

template <class Adapter>
class Runner {
  public:
    Runner(const Input& input) : input(input), adapter(built(input, bytes)), face_values(input.faces()), vertex_values(input.positions) {
        check();
    }

    // Returns the bytes that the library allocated for the mesh.
    size_t size() const { return bytes; }

    // Returns the time of `times` runs and the result of one, or a refusal if the operation is unknown.
    nlohmann::json run(const std::string& name, uint64_t times) {
        uint64_t wall = 0, cpu = 0;
        std::optional<RunResult> found;
        // Moved positions are reset outside the timing. All other operations are timed together, because
        // reading the clocks takes as long as a run on a small mesh.
        const bool moves = name == "vv_smooth";
        const uint64_t batches = moves ? times : 1, runs = moves ? 1 : times;
        for (uint64_t batch = 0; batch < batches; ++batch) {
            const uint64_t start[] = {nanoseconds(CLOCK_MONOTONIC), nanoseconds(CLOCK_THREAD_CPUTIME_ID)};
            for (uint64_t i = 0; i < runs; ++i) {
                found = run_once(name);
                if (!found) return {{"refused", "the adapter does not support the operation"}};
            }
            cpu += nanoseconds(CLOCK_THREAD_CPUTIME_ID) - start[1];
            wall += nanoseconds(CLOCK_MONOTONIC) - start[0];
            if (moves) set_positions(input.positions);
        }
        if (!found) return {{"refused", "zero runs were requested"}};
        return {{"wall_ns", wall}, {"cpu_ns", cpu}, {"checksum", found->checksum}, {"elements", found->elements}};
    }

  private:
    using Vertex = typename Adapter::Vertex;
    using Edge = typename Adapter::Edge;
    using Face = typename Adapter::Face;

    const Input& input;
    size_t bytes = 0;
    std::unique_ptr<Adapter> adapter;
    std::vector<Vector> face_values, vertex_values;

    static std::unique_ptr<Adapter> built(const Input& input, size_t& bytes) {
        const size_t before = allocated();
        auto adapter = std::make_unique<Adapter>(input);
        bytes = allocated() - before;
        return adapter;
    }

    // Refuses a mesh that the structure accepted but does not represent correctly.
    void check() {
        std::set<std::pair<int, int>> sides;
        for (int f = 0; f < input.faces(); ++f) {
            const int first = input.starts[f], count = input.starts[f + 1] - first;
            for (int c = 0; c < count; ++c)
                sides.insert(std::minmax(input.corners[first + c], input.corners[first + (c + 1) % count]));
        }
        const uint64_t vertices = input.positions.size(), corners = input.corners.size(), edges = sides.size();
        auto expect = [&](const char* relation, uint64_t answers, uint64_t elements) {
            const auto found = *query_relation(relation);
            if (found.first != answers || found.second != elements)
                throw std::runtime_error(std::string("it accepted the mesh, but ") + relation + " has " + std::to_string(found.first) +
                                         " results for " + std::to_string(found.second) + " elements, expected " +
                                         std::to_string(answers) + " for " + std::to_string(elements));
        };
        expect("vertex_vertices", 2 * edges, vertices);
        expect("vertex_edges", 2 * edges, vertices);
        expect("vertex_faces", corners, vertices);
        expect("edge_faces", corners, edges);
        expect("face_vertices", corners, input.faces());
        expect("face_edges", corners, input.faces());
        adapter->each_face([&](Face f) {
            std::set<size_t> distinct;
            size_t answers = 0;
            adapter->face_faces(f, [&](Face g) { distinct.insert(adapter->index(g)); ++answers; });
            if (distinct.size() != answers) throw std::runtime_error("it returns a face twice if two faces share more than one edge");
        });
    }

    std::optional<RunResult> run_once(const std::string& name) {
        if (name == "build") {
            Adapter built(input);
            return RunResult{double(input.positions.size() + input.faces()), uint64_t(input.faces())};
        }
        if (name == "circulate") {
            const uint64_t all = query_relation("vertex_faces")->first + query_relation("face_vertices")->first;
            return RunResult{double(all), all};
        }
        if (name == "all_queries") {
            uint64_t all = 0;
            for (const char* relation : {"vertex_vertices", "vertex_edges", "vertex_faces", "edge_vertices", "edge_edges",
                                         "edge_faces", "face_vertices", "face_edges", "face_faces"})
                all += query_relation(relation)->first;
            return RunResult{double(all), all};
        }
        if (name == "face_barycenter") return face_barycenter();
        if (name == "vertex_normal") return vertex_normal();
        if (name == "vv_smooth") return vv_smooth();
        if (name == "edge_length") return edge_length();
        if (name == "boundary") return boundary();
        if (name == "ff_bfs") return ff_bfs();
        const auto counts = query_relation(name);
        if (!counts) return std::nullopt;
        return RunResult{double(counts->first), counts->second};
    }

    // Queries one relation of every element. Returns the numbers of results and of elements.
    std::optional<std::pair<uint64_t, uint64_t>> query_relation(const std::string& relation) {
        const Adapter& a = *adapter;
        uint64_t count = 0, sum = 0, elements = 0;
        auto add = [&](auto handle) {
            ++count;
            sum += a.index(handle);
        };
        auto vertices = [&](auto query) { a.each_vertex([&](Vertex v) { ++elements; query(v); }); };
        auto edges = [&](auto query) { a.each_edge([&](Edge e) { ++elements; query(e); }); };
        auto faces = [&](auto query) { a.each_face([&](Face f) { ++elements; query(f); }); };
        if (relation == "vertex_vertices") vertices([&](Vertex v) { a.vertex_vertices(v, add); });
        else if (relation == "vertex_edges") vertices([&](Vertex v) { a.vertex_edges(v, add); });
        else if (relation == "vertex_faces") vertices([&](Vertex v) { a.vertex_faces(v, add); });
        else if (relation == "edge_vertices") edges([&](Edge e) { const auto ends = a.edge_ends(e); add(ends.first); add(ends.second); });
        else if (relation == "edge_edges") edges([&](Edge e) {
            const auto ends = a.edge_ends(e);
            auto other = [&](Edge x) { if (a.index(x) != a.index(e)) add(x); };
            a.vertex_edges(ends.first, other);
            a.vertex_edges(ends.second, other);
        });
        else if (relation == "edge_faces") edges([&](Edge e) { a.edge_faces(e, add); });
        else if (relation == "face_vertices") faces([&](Face f) { a.face_vertices(f, add); });
        else if (relation == "face_edges") faces([&](Face f) { a.face_edges(f, add); });
        else if (relation == "face_faces") faces([&](Face f) { a.face_faces(f, add); });
        else return std::nullopt;
        sink = sum;
        return std::make_pair(count, elements);
    }

    static double field_sum(const std::vector<Vector>& points) {
        double sum = 0;
        for (const Vector& p : points) sum += std::fabs(double(p.x)) + 2 * std::fabs(double(p.y)) + 3 * std::fabs(double(p.z));
        return sum;
    }

    RunResult face_barycenter() {
        adapter->each_face([&](Face f) {
            Vector sum;
            int corners = 0;
            adapter->face_vertices(f, [&](Vertex v) { sum = sum + adapter->position(v); ++corners; });
            face_values[adapter->index(f)] = sum * (1.0f / float(corners));
        });
        return {field_sum(face_values), face_values.size()};
    }

    RunResult vertex_normal() {
        adapter->each_face([&](Face f) {
            Vector first, last, normal;
            int seen = 0;
            adapter->face_vertices(f, [&](Vertex v) {
                const Vector position = adapter->position(v);
                if (seen == 0) first = position;
                if (seen > 1) normal = normal + cross(last - first, position - first);
                last = position;
                ++seen;
            });
            face_values[adapter->index(f)] = normal;
        });
        adapter->each_vertex([&](Vertex v) {
            Vector sum;
            adapter->vertex_faces(v, [&](Face f) { sum = sum + face_values[adapter->index(f)]; });
            const float size = length(sum);
            vertex_values[adapter->index(v)] = size > 0 ? sum * (1.0f / size) : sum;
        });
        return {field_sum(vertex_values), vertex_values.size()};
    }

    RunResult vv_smooth() {
        adapter->each_vertex([&](Vertex v) {
            Vector sum;
            int valence = 0;
            adapter->vertex_vertices(v, [&](Vertex w) { sum = sum + adapter->position(w); ++valence; });
            vertex_values[adapter->index(v)] = valence > 0 ? sum * (1.0f / float(valence)) : adapter->position(v);
        });
        set_positions(vertex_values);
        return {field_sum(vertex_values), vertex_values.size()};
    }

    void set_positions(const std::vector<Vector>& positions) {
        adapter->each_vertex([&](Vertex v) { adapter->set_position(v, positions[adapter->index(v)]); });
    }

    RunResult edge_length() {
        double sum = 0;
        uint64_t edges = 0;
        adapter->each_edge([&](Edge e) {
            const auto ends = adapter->edge_ends(e);
            sum += length(adapter->position(ends.first) - adapter->position(ends.second));
            ++edges;
        });
        return {sum, edges};
    }

    RunResult boundary() {
        uint64_t boundary = 0, edges = 0;
        adapter->each_edge([&](Edge e) {
            int faces = 0;
            adapter->edge_faces(e, [&](Face) { ++faces; });
            boundary += faces == 1;
            ++edges;
        });
        return {double(boundary), edges};
    }

    // Traverses faces breadth first, each time from the lowest unvisited face.
    RunResult ff_bfs() {
        std::vector<uint32_t> depths(face_values.size(), UINT32_MAX);
        std::deque<Face> queue;
        uint64_t sum = 0;
        for (size_t seed = 0; seed < depths.size(); ++seed) {
            if (depths[seed] != UINT32_MAX) continue;
            depths[seed] = 0;
            queue.push_back(adapter->face(seed));
            while (!queue.empty()) {
                const Face f = queue.front();
                queue.pop_front();
                const uint32_t depth = depths[adapter->index(f)];
                sum += depth;
                adapter->face_faces(f, [&](Face g) {
                    uint32_t& entry = depths[adapter->index(g)];
                    if (entry != UINT32_MAX) return;
                    entry = depth + 1;
                    queue.push_back(g);
                });
            }
        }
        return {double(sum), depths.size()};
    }
};

inline void write_line(const nlohmann::json& what) { std::cout << what.dump() << std::endl; }

// Returns the name and the version of the library, the compiler and its flags.
template <class Adapter>
std::string described() { return Adapter::library() + " (" COMPILER ")"; }

// Runs the whole program: reads the mesh that the first argument names, and answers until standard input ends.
template <class Adapter>
int serve(int argc, char** argv) {
    try {
        if (argc < 2) throw std::runtime_error("the path of a mesh is missing");
        const Input input(argv[1]);
        std::unique_ptr<Runner<Adapter>> runner;
        try {
            runner = std::make_unique<Runner<Adapter>>(input);
        } catch (const std::runtime_error& refusal) {
            write_line({{"protocol", 1}, {"holds", false}, {"library", described<Adapter>()}, {"reason", refusal.what()}});
            return 0;
        }
        // The allocator of the GNU C library: Sixfold can make it keep pages by an environment variable.
#ifdef __GLIBC__
        write_line({{"protocol", 1}, {"holds", true}, {"library", described<Adapter>()}, {"bytes", runner->size()}, {"heap", "glibc"}});
#else
        write_line({{"protocol", 1}, {"holds", true}, {"library", described<Adapter>()}});
#endif
        for (std::string line; std::getline(std::cin, line);) {
            const auto request = nlohmann::json::parse(line);
            write_line(runner->run(request.at("run"), request.at("times")));
        }
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << std::endl;
        return 2;
    }
}

}  // namespace column

// The column of CGAL: Surface_mesh over Simple_cartesian<float>.
#include "column.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/version.h>

using column::Vector;

struct Adapter {
    using Point = CGAL::Simple_cartesian<float>::Point_3;
    using Mesh = CGAL::Surface_mesh<Point>;
    using Vertex = Mesh::Vertex_index;
    using Edge = Mesh::Edge_index;
    using Face = Mesh::Face_index;

    static std::string library() { return "CGAL " CGAL_VERSION_STR " Surface_mesh"; }

    Mesh mesh;

    explicit Adapter(const column::Input& input) {
        mesh.reserve(input.positions.size(), input.corners.size() / 2, input.faces());
        for (const Vector& p : input.positions) mesh.add_vertex(Point(p.x, p.y, p.z));
        std::vector<Vertex> corners;
        for (int f = 0; f < input.faces(); ++f) {
            corners.clear();
            for (int c = input.starts[f]; c < input.starts[f + 1]; ++c) corners.emplace_back(input.corners[c]);
            if (mesh.add_face(corners) == Mesh::null_face()) throw std::runtime_error("it refuses face " + std::to_string(f));
        }
    }

    template <class F> void each_vertex(F f) const { for (Vertex v : mesh.vertices()) f(v); }
    template <class F> void each_edge(F f) const { for (Edge e : mesh.edges()) f(e); }
    template <class F> void each_face(F f) const { for (Face x : mesh.faces()) f(x); }
    template <class Handle> size_t index(Handle handle) const { return size_t(handle.idx()); }
    Face face(size_t number) const { return Face(Mesh::size_type(number)); }
    template <class F> void vertex_vertices(Vertex v, F f) const {
        if (mesh.is_isolated(v)) return;
        for (Vertex w : CGAL::vertices_around_target(mesh.halfedge(v), mesh)) f(w);
    }
    template <class F> void vertex_edges(Vertex v, F f) const {
        if (mesh.is_isolated(v)) return;
        for (auto half : CGAL::halfedges_around_target(mesh.halfedge(v), mesh)) f(mesh.edge(half));
    }
    template <class F> void vertex_faces(Vertex v, F f) const {
        if (mesh.is_isolated(v)) return;
        for (Face x : CGAL::faces_around_target(mesh.halfedge(v), mesh)) if (x != Mesh::null_face()) f(x);
    }
    std::pair<Vertex, Vertex> edge_ends(Edge e) const { return {mesh.vertex(e, 0), mesh.vertex(e, 1)}; }
    template <class F> void edge_faces(Edge e, F f) const {
        for (unsigned side : {0u, 1u}) {
            const Face face = mesh.face(mesh.halfedge(e, side));
            if (face != Mesh::null_face()) f(face);
        }
    }
    template <class F> void face_vertices(Face x, F f) const {
        for (Vertex v : CGAL::vertices_around_face(mesh.halfedge(x), mesh)) f(v);
    }
    template <class F> void face_edges(Face x, F f) const {
        for (auto half : CGAL::halfedges_around_face(mesh.halfedge(x), mesh)) f(mesh.edge(half));
    }
    template <class F> void face_faces(Face x, F f) const {
        for (Face y : CGAL::faces_around_face(mesh.halfedge(x), mesh)) if (y != Mesh::null_face()) f(y);
    }
    Vector position(Vertex v) const {
        const Point& p = mesh.point(v);
        return {p.x(), p.y(), p.z()};
    }
    void set_position(Vertex v, Vector p) { mesh.point(v) = Point(p.x, p.y, p.z); }
};

int main(int argc, char** argv) { return column::serve<Adapter>(argc, argv); }

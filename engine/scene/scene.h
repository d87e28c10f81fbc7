// A scene: everything a run is told, checked before anything is made. Read from TOML (scenes/README.md lists the keys).
// SI units; world: right-handed, y up.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "engine/material/field_spec.h"
#include "engine/material/guide_spec.h"
#include "engine/material/material.h"
#include "engine/mesh/load.h"
#include "engine/mesh/surface_mesh.h"
#include "engine/scene/quality.h"
#include "engine/scene/skip.h"

namespace sherd {

// Generated solids; lengths in metres. make_shape() says how each lies in its own coordinates.
struct BoxShape {
  Vec3 size;
};
struct SphereShape {
  Real radius = 0;
};
struct HollowSphereShape {
  Real radius = 0, inner_radius = 0;
};
struct PlateShape {
  Real width = 0, depth = 0, thickness = 0;  // along x, z, y
};
struct BarShape {
  Real length = 0, height = 0, width = 0;  // along x, y, z
};
struct CylinderShape {
  Real radius = 0, height = 0;
};
struct DinnerPlateShape {
  Real radius = 0, thickness = 0;
};
struct GobletShape {
  Real height = 0, bowl_radius = 0, wall = 0;
};
struct TorusShape {
  Real radius = 0, tube_radius = 0;
};
struct TumblerShape {
  Real height = 0, radius = 0, wall = 0;
};
struct VaseShape {
  Real height = 0, radius = 0, wall = 0;
};
struct FigurineShape {
  Real height = 0;
};
struct TwistedColumnShape {
  Real width = 0, height = 0, turn = 0;  // m, m, rad
};
using ShapeSpec =
    std::variant<BoxShape, SphereShape, HollowSphereShape, PlateShape, BarShape, CylinderShape, DinnerPlateShape,
                 GobletShape, TorusShape, TumblerShape, VaseShape, FigurineShape, TwistedColumnShape>;

// How large the mesh of a file becomes; the factor is uniform.
enum class MeshFit {
  kScale,   // multiply coordinates by `amount`
  kHeight,  // make the extent along y `amount` metres
  kSize,    // make the largest extent `amount` metres
};
struct MeshSpec {
  std::filesystem::path file;  // absolute, or relative to the working directory; exists
  MeshFit fit = MeshFit::kScale;
  Real amount = 1;
  UpAxis up = UpAxis::kY;  // of the file; turned to y before anything else
  Real max_hole = 0;       // holes up to this diameter (m, after scaling) are filled; 0 asks for 5 % of the diagonal
};

enum class Anchor {
  kCentreOfMass,  // `position` is where the centre of mass goes
  kBase,  // `position` is where the lowest point goes (y), under the bounding box's centre (x, z), after rotation
};

inline constexpr Real kDefaultEdge = 1.0 / 40;  // edge length where none is given, of the bounding-box diagonal

// A crack that follows a guide, whatever the stress.
struct SceneCrack {
  // Material space (after scaling). A path: a mesh file in the coordinates of the body's own file (metres for a shape).
  std::variant<GuidePlane, GuidePolyline, std::filesystem::path> guide;
  Real time = 0;  // s; when it happens, 0: before the first step
};

// A wedge cut out of the body before the first step: `width` wide at the surface, its tip at the guide's depth.
struct SceneNotch {
  NotchSpec guide;
  Real width = 0;  // m
};

struct SceneBody {
  std::string name;  // unique; letters, digits, '_' and '-', so that it can name files
  std::variant<MeshSpec, ShapeSpec> source;
  Real edge_length = 0;         // target edge of the surface mesh, m; 0 asks for 1/40 of the diagonal
  Real edge_factor = 1;         // times either: the run's quality
  Real edge_per_thickness = 0;  // edges at most this many times as long as the wall is thick; 0: edge_length everywhere
  Real merge_features = 0.02;   // creases closer than this part of the edges are merged where they force slivers
  Anchor anchor = Anchor::kCentreOfMass;
  Vec3 position;          // m
  Vec3 rotation;          // rotation vector (unit axis times angle), radians, material to world
  Vec3 velocity;          // of the centre of mass, m/s
  Vec3 angular_velocity;  // rad/s, world
  Material material;      // resolved: preset with the scene's changes; means where a field varies
  // Nothing: the material's number everywhere.
  std::optional<FieldSpec> strength, propagation_strength, crack_thickness;
  std::vector<SceneCrack> cracks;
  std::vector<SceneNotch> notches;
  bool fixed = false;
  bool breakable = true;       // false for every fixed body
  std::optional<Vec3> colour;  // linear RGB, 0..1; nothing: the renderer chooses
  std::optional<Vec3> crack_colour;
};

struct SceneGround {
  bool enabled = true;
  Real height = 0;         // m, plane y = height
  Real restitution = 0.2;  // 0..1
  Real friction = 0.6;     // >= 0
};

struct SceneContact {
  std::optional<Real> duration;      // s; nothing: Hertz impact time
  Real min_duration = 1e-3;          // s; lower bound of the Hertz time, the time step unless the scene says otherwise
  std::optional<Real> patch_radius;  // m; nothing: Hertz contact radius
  Real min_patch_radius = 0;         // m; lower bound of the Hertz radius
};

// Where the elastostatic equations are averaged over elements instead of asked for at vertices: an order of magnitude
// slower to set up, and what keeps the bending of walls thinner than the elements from coming out too stiff.
enum class ThinWalls {
  kAuto,  // where elements are longer than the wall is thick
  kOff,   // nowhere
  kAll,   // everywhere
};

struct SceneSolver {
  Real tolerance = 1e-4;  // relative residual
  int max_iterations = 300;
  ThinWalls thin_walls = ThinWalls::kAuto;
  Real edge_factor = 1;  // kAuto: times the edges from which walls count as thin; the run's quality
};

// What becomes of pieces below SceneFracture::min_fragment_volume.
enum class SceneDust {
  kDrop,  // they vanish; their volume is recorded
  kKeep,  // they stay as pieces that do not break
};

struct SceneFracture {
  bool enabled = true;
  int max_cracks = 8;               // per body and event
  int max_fragments = 200;          // alive in the scene; at this number nothing breaks any more
  Real min_fragment_volume = 1e-4;  // of the scene body's volume; smaller pieces neither appear nor break
  int max_generation = 4;           // a fragment of this generation breaks no further (scene bodies are generation 0)
  bool net_section = true;          // a stopped crack goes through when the rest of its section cannot bear the load
  int rounds = 1;  // times an event solves anew on the pieces that still bear the load: cracks that follow from cracks
  bool interior_seeds = false;  // also start cracks inside, where the stress exceeds the strength most
  SceneDust dust = SceneDust::kDrop;
  Real speed = 0.5;  // fraction of an edge a front moves per sub-step at the initiation strength (alpha)
};

// Forces on an unbroken scene body beside those of contacts: they stress it (and may break it) but do not move it.
struct SceneLoad {
  std::size_t body = 0;  // index in Scene::bodies, a breakable one
  Box region;            // material space, m: acts on the original surface inside
  Vec3 facing;           // only on faces within 45 degrees of this direction (unit); zero: on any
  Vec3 force;            // N, material axes, spread evenly over the region
  Vec3 moment;           // N m, material axes, a couple: spread as w x (x - centroid of the region)
  Real from = 0;         // s
  Real until = std::numeric_limits<Real>::infinity();  // s, exclusive
};

struct SceneCamera {
  bool automatic = true;  // frame the bodies and where they will fall; then eye and target are unused
  Vec3 eye{0, 1, 3}, target, up{0, 1, 0};
  Real field_of_view = 40;  // vertical, degrees
};

struct SceneLight {
  Vec3 direction{0.5, 1.0, 0.4};  // towards the sun
};

// A quantity of the last solve of each body, shown as colours of its surface.
enum class FieldKind {
  kDisplacement,  // its size, m
  kStrainEnergy,  // density, J/m^3
  kMaxPrincipal,  // largest principal stress, Pa
};
// In the order of FieldKind.
inline constexpr std::array<std::string_view, 3> kFieldNames{"displacement", "strain_energy", "max_principal"};
inline constexpr std::array<std::string_view, 3> kFieldUnits{"m", "J/m3", "Pa"};

struct SceneField {
  FieldKind kind = FieldKind::kDisplacement;
  std::optional<std::pair<Real, Real>> range;  // what the colours span; nothing: found from the values
  Real deformation = 0;                        // displacements are drawn times this
};

struct SceneOutput {
  int width = 1280, height = 720;  // pixels
  int samples = 4;                 // per pixel: 1, 2, 4 or 8
  bool frames = true, movie = true, pieces = true;
  std::optional<std::size_t>
      material_view;  // body (index in Scene::bodies) also drawn in material space with its cracks
  std::optional<SceneField> field;
};

struct Scene {
  std::filesystem::path file;  // as given to load_scene
  // Of what the file says (not of comments and layout) and of the mesh files it names: another scene has another one.
  std::uint64_t digest = 0;
  Quality quality = Quality::kDefault;  // already applied to what follows
  Vec3 gravity{0, -9.81, 0};            // m/s^2
  Real time_step = 1e-3;                // s
  Real duration = 2;                    // s
  Real frame_rate = 60;                 // frames per second of simulated time, at most one a step
  std::vector<SceneBody> bodies;
  std::vector<SceneLoad> loads;
  SceneGround ground;
  SceneContact contact;
  SceneSolver solver;
  SceneFracture fracture;
  SceneSkip skip;
  SceneCamera camera;
  SceneLight light;
  SceneOutput output;
};

// Throws InputError naming every problem found, one a line and in file order, each as
// "file:line:column: key: value X not allowed; allowed range Y". Creates nothing; mesh files are only looked for.
// `quality` stands before the scene's own.
Scene load_scene(const std::filesystem::path& file, std::optional<Quality> quality = {});

// The body's mesh about its own origin, before remeshing: generated, or loaded, scaled and repaired. `messages` gets a
// sentence for everything loading and repair changed. Throws InputError naming the file for what cannot be repaired.
SurfaceMesh scene_mesh(const SceneBody& body, std::vector<std::string>& messages);
// The material's fields of a body, propagation strength at most the strength at every point. `mesh`: the body's, with
// its channels. Throws InputError naming the body when a channel is missing.
MaterialFields scene_fields(const SceneBody& body, const SurfaceMesh& mesh);
// What a crack is to follow, the mesh file loaded and scaled as the body's own. Throws InputError naming the file when
// it is no open, consistently oriented surface.
GuideSpec scene_guide(const SceneBody& body, const SceneCrack& crack, std::vector<std::string>& messages);
// The edge length a body of this bounding-box diagonal (m) is meshed with, m: its edge_length, or the default that
// stands for 0, times its edge_factor.
Real scene_edge_length(const SceneBody& body, Real diagonal);

// The closed surface of a generated solid about its own origin, with the given target edge length (m, > 0).
SurfaceMesh make_shape(const ShapeSpec& shape, Real edge_length);
// Length of the bounding-box diagonal of a generated solid, m.
Real shape_diagonal(const ShapeSpec& shape);

}  // namespace sherd

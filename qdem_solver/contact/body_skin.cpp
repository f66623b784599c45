#include "qdem_solver/contact/body_skin.hpp"

#include "qdem_solver/contact/sphere_radii.hpp"

namespace qdem {

std::vector<BodySkin> make_skins(const Model& model) {
  std::vector<std::vector<double>> radii(model.templates.size());
  if (model.contact.shape == ContactShape::sphere) {
    for (std::size_t t = 0; t < radii.size(); ++t) radii[t] = sphere_radii(model.contact, model.templates[t]);
  }
  std::vector<BodySkin> skins;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const double scale = model.bodies[b].scale;
    const Template& shape = model.shape(b);
    const SkinView view{shape.triangles.data(),
                        shape.edges.data(),
                        model.index(b, 0),
                        model.stride(b),
                        model.material(b).density * scale * scale * scale,
                        model.body_mass(b)};
    skins.push_back({view, &shape, radii[model.bodies[b].template_id]});
  }
  return skins;
}

}  // namespace qdem

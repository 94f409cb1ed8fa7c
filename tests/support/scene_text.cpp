#include "scene_text.h"

namespace parhelion::test {

std::string SceneText::text() const {
    const std::string sensor = R"(<sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="4"/></sampler>
    <film type="hdrfilm">
        )" + width + R"(
        <integer name="height" value="12"/>
        <rfilter type="box"/>
    </film>
</sensor>)";
    return "<scene version=\"3.0.0\">\n" + start + "\n" + integrator + "\n" + sensor + "\n" + emitter + "\n" + medium +
           "\n" + shape + "\n" + end;
}

std::string gridMedium(const std::string& volumeFile) {
    return R"(<medium id="fog" type="heterogeneous">
    <float name="scale" value="4"/>
    <volume name="sigma_t" type="gridvolume">
        <string name="filename" value=")" +
           volumeFile + R"("/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform>
    </volume>
    <rgb name="albedo" value="0.8, 0.8, 0.8"/>
</medium>)";
}

}  // namespace parhelion::test

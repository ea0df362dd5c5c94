"""What a stack is made of: interfaces and the media between them."""

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from goniosim.scene.quantity import Number, PerChannel, Triple, mistake, rgb

DielectricEta = Number(0.1, 10.0, "lie between 0.1 and 10: it is the absolute index below the interface")
ConductorEta = Number(1e-3, 1e3, "lie between 0.001 and 1000: it is the real part of the absolute index")
Kappa = Number(0.0, 1e6, "lie between 0 and 1e6: it is the imaginary part of the absolute index")
Alpha = Number(
    1e-6,
    1.0,
    "be 0 or lie between 1e-6 and 1: it is the GGX width; use 0 for a smooth interface",
    zero_below=True,
)
Rho = Number(0.0, 1.0, "lie between 0 and 1: it is the fraction of the light that the base sends back")
Tau = Number(0.0, 1e9, "be 0 or more (1e9 at most): it is the optical depth, and 0 absorbs nothing")


class Part(BaseModel):
    """Base of everything in a scene: immutable, and closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Dielectric(Part):
    """Interface to a transparent medium, GGX-rough or smooth."""

    opaque: ClassVar[bool] = False

    type: Literal["dielectric"]
    eta: Annotated[float, DielectricEta] = Field(description="Absolute refractive index below the interface.")
    alpha: Annotated[float, Alpha] = Field(default=0.0, description="GGX width; 0 is a smooth interface.")


class Conductor(Part):
    """Opaque metallic base, GGX-rough or smooth."""

    opaque: ClassVar[bool] = True

    type: Literal["conductor"]
    eta: Annotated[float | Triple, PerChannel(ConductorEta)] = Field(
        description="Real part of the absolute refractive index, one number or one for each channel."
    )
    kappa: Annotated[float | Triple, PerChannel(Kappa)] = Field(
        description="Imaginary part of the absolute refractive index, one number or one for each channel."
    )
    alpha: Annotated[float, Alpha] = Field(default=0.0, description="GGX width; 0 is a smooth interface.")

    @property
    def eta_rgb(self) -> Triple:
        """Real part of the index per channel, tuple of 3 floats."""
        return rgb(self.eta)

    @property
    def kappa_rgb(self) -> Triple:
        """Imaginary part of the index per channel, tuple of 3 floats."""
        return rgb(self.kappa)


class Lambert(Part):
    """Opaque diffuse base."""

    opaque: ClassVar[bool] = True

    type: Literal["lambert"]
    rho: Annotated[float | Triple, PerChannel(Rho)] = Field(
        description="Diffuse albedo, one number or one for each channel."
    )

    @property
    def rho_rgb(self) -> Triple:
        """Albedo per channel, tuple of 3 floats."""
        return rgb(self.rho)


class Medium(Part):
    """Absorbing medium between two interfaces."""

    tau: Annotated[float | Triple, PerChannel(Tau)] = Field(
        description="Optical depth of one perpendicular crossing, one number or one for each channel."
    )

    @property
    def tau_rgb(self) -> Triple:
        """Optical depth per channel, tuple of 3 floats."""
        return rgb(self.tau)


Kind = Dielectric | Conductor | Lambert
Interface = Annotated[Kind, Field(discriminator="type")]
INTERFACES: dict[str, type[Kind]] = {"dielectric": Dielectric, "conductor": Conductor, "lambert": Lambert}


# Stands for an absent key, never for a null that was written: a default of any type.
ABSENT: Any = None


class Layer(Part):
    """One entry of the stack: an interface or a medium."""

    model_config = ConfigDict(json_schema_extra={"oneOf": [{"required": ["interface"]}, {"required": ["medium"]}]})

    interface: Interface = Field(default=ABSENT, description="A boundary where light is reflected and refracted.")
    medium: Medium = Field(default=ABSENT, description="What fills the space between two interfaces.")

    @model_validator(mode="before")
    @classmethod
    def _labelled(cls, content: object) -> object:
        if isinstance(content, dict) and not {"interface", "medium"} & content.keys():
            if "type" in content:
                raise mistake("must say that it is an interface: write `interface: {type: ...}`")
            if "tau" in content:
                raise mistake("must say that it is a medium: write `medium: {tau: ...}`")
        return content

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.interface is None) == (self.medium is None):
            raise mistake("must hold either an interface or a medium: give each its own `- ` in the list")
        return self

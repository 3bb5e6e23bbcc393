"""What a scene may call for: each effect a function from one waist type to itself."""
